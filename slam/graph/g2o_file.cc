#include "slam/graph/g2o_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "robot/base/nearest_name.h"
#include "robot/base/text_fields.h"
#include "slam/graph/edge_error.h"
#include "slam/graph/initial_poses.h"
#include "slam/graph/parts.h"
#include "slam/graph/semidefinite.h"

namespace merlin {
namespace {

constexpr double kLargest_m = 1e9, kLargestAngle_rad = 1e6, kLargestInformation = 1e15;
constexpr double kUnitTolerance = 1e-5;  // files of six digits stay below
constexpr double kShortestQuaternion = 1e-6;
constexpr double kIndefiniteTolerance = 1e-9;  // of the largest eigenvalue: rounding in a file of nine digits
constexpr std::array<std::string_view, 5> kTags{"VERTEX_SE2", "EDGE_SE2", "VERTEX_SE3:QUAT", "EDGE_SE3:QUAT", "FIX"};
// g2o's edges that are measured from the mounting pose of a sensor, which a PARAMS line gives.
constexpr std::array<std::string_view, 10> kTagsWithParameters{
    "EDGE_SE2_OFFSET",     "EDGE_SE2_POINTXY_OFFSET", "EDGE_SE3_OFFSET",    "EDGE_SE3_PRIOR",    "EDGE_SE3_TRACKXYZ",
    "EDGE_SE3_LOTSOF_XYZ", "EDGE_PROJECT_DISPARITY",  "EDGE_PROJECT_DEPTH", "EDGE_PROJECT_P2MC", "EDGE_PROJECT_P2SC"};

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
  explicit Reader(const std::string& name) : name_(name), faults_(name) {}

  G2oFile Read(std::string_view text) {
    ForEachLine(text, [this](std::string_view line, std::size_t number) {
      const std::size_t vertices = vertices_.size();
      const bool read = faults_.Try([&] { ReadLine(line, number); });
      const bool other = line.starts_with("EDGE") || line.starts_with("FIX");
      lost_vertex_ = lost_vertex_ || (!read && !other && vertices_.size() == vertices);
    });
    if (edges_.empty() && faults_.empty())
      throw InputError(name_, "no edges", "at least one EDGE_SE2 or EDGE_SE3:QUAT");
    PlaceVertices();
    ResolveEdges();
    ResolveFixed();
    faults_.ThrowIfAny();
    file_.graph.planar = *planar_;
    PlaceParts();
    Warn();
    return std::move(file_);
  }

 private:
  void ReadLine(std::string_view line, std::size_t number) {
    TextFields fields(line, name_, number);
    const std::string_view tag = fields.Word();
    if (tag.empty() || tag.starts_with('#') || tag.starts_with("PARAMS_")) return;
    if (std::ranges::find(kTagsWithParameters, tag) != kTagsWithParameters.end())
      throw InputError(fields.where(), "an edge that uses a PARAMS line, which is not supported",
                       "EDGE_SE2 or EDGE_SE3:QUAT", Quoted(tag));
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

  // Keeps the ids of a line with a later fault, so that no other line is blamed for them.
  void ReadVertex(TextFields& fields, std::size_t number) {
    vertices_.push_back({.id = fields.Whole("the pose's id"), .line = number});
    vertices_.back().T_map_pose = ReadPose(fields, number);
  }

  void ReadEdge(TextFields& fields, std::size_t number, std::string_view line) {
    Ends ends{.from = fields.Whole("the first pose's id"), .line = number, .text = line};
    ends.to = fields.Whole("the second pose's id");
    if (ends.from == ends.to) throw InputError(fields.where(), "an edge from a pose to itself");
    edges_.push_back(ends);
    GraphEdge& edge = file_.graph.edges.emplace_back();
    edge.T_from_to = ReadPose(fields, number);
    edge.information = ReadInformation(fields, number);
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
    for (std::size_t i = 1; file_.has_poses && i < vertices_.size(); ++i)
      if (const Vertex& first = vertices_[i - 1], &again = vertices_[i]; first.id == again.id)
        faults_.Add(fmt::format("{}: pose {} again; it is in line {} already", At(again.line), again.id, first.line));
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
    for (std::size_t i = 0; i < edges_.size() && !lost_vertex_; ++i) {
      faults_.Try([&] { file_.graph.edges[i].from = IndexOf(edges_[i].from, edges_[i].line); });
      faults_.Try([&] { file_.graph.edges[i].to = IndexOf(edges_[i].to, edges_[i].line); });
    }
  }

  void ResolveFixed() {
    std::vector<std::size_t>& indices = file_.graph.fixed;
    for (std::size_t i = 0; i < fixed_.size() && !lost_vertex_; ++i)
      faults_.Try([&] { indices.push_back(IndexOf(fixed_[i].id, fixed_[i].line)); });
    std::ranges::sort(indices);
    const auto repeated = std::ranges::unique(indices);
    indices.erase(repeated.begin(), repeated.end());
  }

  // Without VERTEX lines each part has its own frame, in which at most one pose is known.
  void PlaceParts() {
    std::vector<GraphPart> parts = PartsOf(file_.graph);
    if (!file_.has_poses) {
      for (GraphPart& part : parts) {
        if (part.graph.fixed.size() > 1) {
          const std::int64_t id = file_.ids[part.poses[part.graph.fixed.back()]];
          throw InputError(At(std::ranges::find(fixed_, id, &Vertex::id)->line),
                           "more than one FIX, but no VERTEX says where these poses are");
        }
        part.graph.poses = ChainedPoses(part.graph);
        PutPoses(part, file_.graph);
      }
    }
    if (parts.size() == 1) return;
    const auto single = std::ranges::count_if(parts, [](const GraphPart& part) { return part.poses.size() == 1; });
    file_.warnings.push_back(fmt::format(
        "{}: the graph has {} parts that no edge joins; each is solved by itself, about its FIX or its first "
        "pose{}",
        name_, parts.size(), single > 0 ? fmt::format(" ({} of one pose, which stays)", single) : ""));
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
  FaultList faults_;
  bool lost_vertex_ = false;  // a refused line may have been a pose, so missing poses are no faults of other lines
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
