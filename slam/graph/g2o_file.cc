#include "slam/graph/g2o_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "robot/types/error.h"
#include "robot/types/nearest_name.h"
#include "robot/types/text_fields.h"
#include "slam/graph/edge_error.h"
#include "slam/graph/initial_poses.h"
#include "slam/graph/semidefinite.h"

namespace merlin {
namespace {

constexpr double kLargest_m = 1e9, kLargestAngle_rad = 1e6, kLargestInformation = 1e15;
constexpr double kUnitTolerance = 1e-5;  // files of six digits stay below
constexpr double kShortestQuaternion = 1e-6;
constexpr double kIndefiniteTolerance = 1e-9;  // of the largest eigenvalue: rounding in a file of nine digits
constexpr std::array<std::string_view, 5> kTags{"VERTEX_SE2", "EDGE_SE2", "VERTEX_SE3:QUAT", "EDGE_SE3:QUAT", "FIX"};

struct Vertex {
  std::int64_t id = 0;
  std::size_t line = 0;
  Pose T_map_pose = Pose::Identity();
};

struct Ends {
  std::int64_t from = 0, to = 0;
  std::size_t line = 0;
  std::string_view text;
};

Matrix6d Rescaled(Matrix6d information, double rotation_factor) {
  information.topRightCorner<3, 3>() *= rotation_factor;
  information.bottomLeftCorner<3, 3>() *= rotation_factor;
  information.bottomRightCorner<3, 3>() *= rotation_factor * rotation_factor;
  return information;
}

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  G2oFile Read(std::string_view text) {
    ForEachLine(text, [this](std::string_view line, std::size_t number) { ReadLine(line, number); });
    if (edges_.empty()) throw InputError(name_, "no edges", "at least one EDGE_SE2 or EDGE_SE3:QUAT");
    file_.graph.planar = *planar_;
    PlaceVertices();
    ResolveEdges();
    ResolveFixed();
    RequireOneComponent();
    if (!file_.has_poses) file_.graph.poses = ChainedPoses(file_.graph);
    Warn();
    return std::move(file_);
  }

 private:
  void ReadLine(std::string_view line, std::size_t number) {
    TextFields fields(line, name_, number);
    const std::string_view tag = fields.Word();
    if (tag.empty() || tag.starts_with('#')) return;
    if (std::ranges::find(kTags, tag) == kTags.end()) {
      const std::string nearest = NearestName(tag.substr(0, 40), kTags);
      throw InputError(fields.where(), "unknown tag", nearest + " or another of g2o's poses and edges", Quoted(tag));
    }
    if (tag == "FIX") return ReadFix(fields, number);
    const bool planar = tag.ends_with("SE2");
    if (planar_.value_or(planar) != planar)
      throw InputError(fields.where(), "planar (SE2) and spatial (SE3) lines in one file");
    planar_ = planar;
    if (tag.starts_with("VERTEX"))
      ReadVertex(fields, number);
    else
      ReadEdge(fields, number, line);
    fields.RequireEnd(tag);
  }

  void ReadFix(TextFields& fields, std::size_t number) {
    do {
      fixed_.push_back({.id = fields.Whole("the id of the pose to fix"), .line = number});
    } while (!fields.AtEnd());
  }

  void ReadVertex(TextFields& fields, std::size_t number) {
    Vertex vertex{.id = fields.Whole("the pose's id"), .line = number};
    vertex.T_map_pose = ReadPose(fields, number);
    vertices_.push_back(vertex);
  }

  void ReadEdge(TextFields& fields, std::size_t number, std::string_view line) {
    GraphEdge edge;
    Ends ends{.from = fields.Whole("the first pose's id"),
              .to = fields.Whole("the second pose's id"),
              .line = number,
              .text = line};
    if (ends.from == ends.to) throw InputError(fields.where(), "an edge from a pose to itself");
    edge.T_from_to = ReadPose(fields, number);
    edge.information = ReadInformation(fields, number);
    edges_.push_back(ends);
    file_.graph.edges.push_back(edge);
  }

  Pose ReadPose(TextFields& fields, std::size_t number) {
    const double x_m = fields.Number("x", kLargest_m), y_m = fields.Number("y", kLargest_m);
    if (*planar_) return FromXyYaw(x_m, y_m, fields.Number("the angle", kLargestAngle_rad));
    Pose pose(Eigen::Translation3d(x_m, y_m, fields.Number("z", kLargest_m)));
    Eigen::Quaterniond q;
    for (double& value : q.coeffs()) value = fields.Number("the quaternion", kLargest_m);
    if (!(q.norm() > kShortestQuaternion)) throw InputError(fields.where(), "a quaternion of no length");
    if (std::abs(q.norm() - 1.0) > kUnitTolerance) off_unit_.push_back(number);
    pose.linear() = q.normalized().toRotationMatrix();
    return pose;
  }

  // The upper triangle, row by row. Of a plane: x, y, yaw.
  Matrix6d ReadInformation(TextFields& fields, std::size_t number) {
    const std::vector<int> rows = *planar_ ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
    Matrix6d information = Matrix6d::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = i; j < rows.size(); ++j)
        information(rows[i], rows[j]) = information(rows[j], rows[i]) =
            fields.Number("the information matrix", kLargestInformation);
    if (const auto semidefinite = MadeSemidefinite(information, kIndefiniteTolerance)) {
      indefinite_.push_back(number);
      information = *semidefinite;
    }
    return *planar_ ? information : Rescaled(information, 0.5);  // the quaternion's vector part is half our rotation
  }

  void PlaceVertices() {
    file_.has_poses = !vertices_.empty();
    if (!file_.has_poses) {
      for (const Ends& edge : edges_)
        for (const std::int64_t id : {edge.from, edge.to}) vertices_.push_back({.id = id, .line = edge.line});
    }
    std::ranges::stable_sort(vertices_, {}, &Vertex::id);
    const auto twice = std::ranges::adjacent_find(vertices_, {}, &Vertex::id);
    if (file_.has_poses && twice != vertices_.end())
      throw InputError(At((twice + 1)->line),
                       fmt::format("pose {} again; it is in line {} already", twice->id, twice->line));
    const auto repeated = std::ranges::unique(vertices_, {}, &Vertex::id);
    vertices_.erase(repeated.begin(), repeated.end());
    for (const Vertex& vertex : vertices_) {
      file_.ids.push_back(vertex.id);
      file_.graph.poses.push_back(vertex.T_map_pose);
    }
  }

  std::size_t IndexOf(std::int64_t id, std::size_t line) const {
    const auto found = std::ranges::lower_bound(file_.ids, id);
    if (found == file_.ids.end() || *found != id) throw InputError(At(line), fmt::format("there is no pose {}", id));
    return static_cast<std::size_t>(found - file_.ids.begin());
  }

  void ResolveEdges() {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      file_.graph.edges[i].from = IndexOf(edges_[i].from, edges_[i].line);
      file_.graph.edges[i].to = IndexOf(edges_[i].to, edges_[i].line);
    }
  }

  void ResolveFixed() {
    for (const Vertex& fixed : fixed_) file_.graph.fixed.push_back(IndexOf(fixed.id, fixed.line));
    std::vector<std::size_t>& indices = file_.graph.fixed;
    std::ranges::sort(indices);
    const auto repeated = std::ranges::unique(indices);
    indices.erase(repeated.begin(), repeated.end());
    if (!file_.has_poses && indices.size() > 1)
      throw InputError(At(fixed_.back().line), "more than one FIX, but no VERTEX says where these poses are");
  }

  void RequireOneComponent() const {
    std::vector<std::size_t> parent(file_.ids.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&parent](std::size_t i) {
      for (; parent[i] != i; i = parent[i]) parent[i] = parent[parent[i]];
      return i;
    };
    for (const GraphEdge& edge : file_.graph.edges) parent[root(edge.from)] = root(edge.to);
    for (std::size_t i = 1; i < parent.size(); ++i)
      if (root(i) != root(0))
        throw InputError(At(vertices_[i].line),
                         fmt::format("no chain of edges joins pose {} to pose {}", file_.ids[i], file_.ids[0]));
  }

  std::vector<std::size_t> RepeatedEdges() {
    std::ranges::stable_sort(edges_, {}, &Ends::text);
    std::vector<std::size_t> lines;
    for (std::size_t i = 1; i < edges_.size(); ++i)
      if (edges_[i].text == edges_[i - 1].text) lines.push_back(edges_[i].line);
    std::ranges::sort(lines);
    return lines;
  }

  void Warn() {
    const auto warn = [this](const std::vector<std::size_t>& lines, const char* one, const char* many,
                             const char* what) {
      if (!lines.empty())
        file_.warnings.push_back(fmt::format("{}: {} {} {} ({})", name_, lines.size(), lines.size() == 1 ? one : many,
                                             what, LinesOf(lines)));
    };
    warn(indefinite_, "information matrix is", "information matrices are",
         "not positive semidefinite; negative eigenvalues were set to zero");
    warn(off_unit_, "quaternion is", "quaternions are", "off unit length; normalised");
    warn(RepeatedEdges(), "edge is", "edges are", "said before, word for word; counted again");
  }

  std::string At(std::size_t line) const { return fmt::format("{}:{}", name_, line); }

  const std::string& name_;
  G2oFile file_;
  std::optional<bool> planar_;
  std::vector<Vertex> vertices_, fixed_;
  std::vector<Ends> edges_;
  std::vector<std::size_t> off_unit_, indefinite_;
};

void AppendPose(std::string& text, const Pose& pose, bool planar) {
  const Eigen::Vector3d t = pose.translation();
  const auto out = std::back_inserter(text);
  if (planar) {
    fmt::format_to(out, " {} {} {}", t.x(), t.y(), Yaw(pose));
    return;
  }
  Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  fmt::format_to(out, " {} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

template <class Matrix>
void AppendUpperTriangle(std::string& text, const Matrix& information) {
  for (int i = 0; i < information.rows(); ++i)
    for (int j = i; j < information.cols(); ++j) fmt::format_to(std::back_inserter(text), " {}", information(i, j));
}

}  // namespace

G2oFile ParseG2o(std::string_view text, const std::string& name) { return Reader(name).Read(text); }

std::string ToG2o(const G2oFile& file) {
  const PoseGraph& graph = file.graph;
  const char* const kind = graph.planar ? "SE2" : "SE3:QUAT";
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    fmt::format_to(out, "VERTEX_{} {}", kind, file.ids[i]);
    AppendPose(text, graph.poses[i], graph.planar);
    text += '\n';
  }
  for (const std::size_t fixed : graph.fixed) fmt::format_to(out, "FIX {}\n", file.ids[fixed]);
  for (const GraphEdge& edge : graph.edges) {
    fmt::format_to(out, "EDGE_{} {} {}", kind, file.ids[edge.from], file.ids[edge.to]);
    AppendPose(text, edge.T_from_to, graph.planar);
    if (graph.planar)
      AppendUpperTriangle(text, Planar::Part(edge.information));
    else
      AppendUpperTriangle(text, Rescaled(edge.information, 2.0));
    text += '\n';
  }
  return text;
}

}  // namespace merlin
