#include "sim/world/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "robot/base/error.h"
#include "sim/world/mesh_pieces.h"
#include "sim/world/room.h"
#include "sim/world/shape.h"
#include "sim/world/spec.h"

namespace merlin::sim {
namespace {

constexpr char kPieceMark = '#';
constexpr int kPieceGroup = 3;  // not drawn, and ignored by the rays of the depth camera

// Whether it shares a bit with MuJoCo's defaults (1 and 1), for which rooms are usually written.
bool MeetsDefault(const mjsGeom* geom) { return (geom->contype & 1) != 0 || (geom->conaffinity & 1) != 0; }

bool Collides(const mjsGeom* geom) { return geom->contype != 0 || geom->conaffinity != 0; }

class Judge {
 public:
  Judge(mjSpec* spec, const mjModel* alone, const Materials& materials)
      : model_(alone), data_(mj_makeData(alone), mj_deleteData), materials_(GeomMaterials(alone, materials)) {
    if (!data_) throw std::runtime_error("MuJoCo cannot make its data: out of memory");
    mj_kinematics(model_, data_.get());
    for (mjsElement* e = mjs_firstElement(spec, mjOBJ_GEOM); e != nullptr; e = mjs_nextElement(spec, e))
      geoms_.push_back(mjs_asGeom(e));
    if (std::ssize(geoms_) != model_->ngeom) throw std::logic_error("a spec and its model differ in their geoms");
  }

  // By geom.
  std::vector<bool> MeetsCar() {
    const int count = static_cast<int>(geoms_.size());
    std::vector<bool> meets(geoms_.size());
    for (int geom = 0; geom < count; ++geom) {
      const bool shows = IsSeen(model_, geom) || IsFloor(model_, geom);
      meets[geom] = Collides(geoms_[geom]) && (MeetsDefault(geoms_[geom]) || (shows && !Passable(geom)));
      if (Collides(geoms_[geom])) solids_.emplace_back(model_, data_.get(), geom);
    }
    for (int geom = 0; geom < count; ++geom) {
      if (Collides(geoms_[geom]) || Passable(geom) || !(IsSeen(model_, geom) || IsFloor(model_, geom))) continue;
      const std::vector<int> standing = StandsFor(geom);
      if (standing.empty()) meets[geom] = true;
      for (const int other : standing) meets[other] = true;
      if (IsFloor(model_, geom)) grounds_.insert(grounds_.end(), standing.begin(), standing.end());
    }
    for (int geom = 0; geom < count; ++geom)
      if (meets[geom] && IsGround(geom)) floors_.emplace_back(model_, data_.get(), geom);
    return meets;
  }

  // Whether a floor stands in for a part of this geom. corners: of that part, in the geom's frame.
  bool LiesOnFloor(int geom, const std::vector<Eigen::Vector3d>& corners) const {
    if (IsFloor(model_, geom)) return false;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->geom_xmat + 9 * geom);
    const Eigen::Vector3d position = Eigen::Vector3d::Map(data_->geom_xpos + 3 * geom);
    return std::ranges::any_of(floors_, [&](const Solid& floor) {
      return MoveAsOne(floor.geom(), geom) && std::ranges::all_of(corners, [&](const Eigen::Vector3d& corner) {
               return floor.Distance_m(R * corner + position, kFloorStandsFor_m) <= kFloorStandsFor_m;
             });
    });
  }

  const std::vector<mjsGeom*>& geoms() const { return geoms_; }
  const std::vector<int>& grounds() const { return grounds_; }
  bool Panel(int geom) const { return IsPanel(model_, data_.get(), geom); }

 private:
  bool Passable(int geom) const { return materials_[geom].passable && !IsFloor(model_, geom); }

  bool IsGround(int geom) const {
    return IsFloor(model_, geom) || (model_->geom_type[geom] == mjGEOM_PLANE && !Panel(geom));
  }
  bool MoveAsOne(int a, int b) const {
    return model_->body_weldid[model_->geom_bodyid[a]] == model_->body_weldid[model_->geom_bodyid[b]];
  }

  double Near_m(int geom, int of) const {
    const int body = model_->geom_bodyid[of];
    if (IsGround(geom)) return kFloorStandsFor_m;
    return body != 0 && body == model_->geom_bodyid[geom] ? kStandsForInBody_m : kStandsFor_m;
  }

  // The colliding geoms that together stand in for this one; empty if they leave a point uncovered.
  std::vector<int> StandsFor(int geom) const {
    struct Candidate {
      const Solid* solid;
      double near_m;
    };
    std::vector<Candidate> candidates;
    for (const Solid& solid : solids_)
      if (MoveAsOne(solid.geom(), geom)) candidates.push_back({&solid, Near_m(solid.geom(), geom)});
    std::vector<int> standing;
    for (const Eigen::Vector3d& point : PointsOn(model_, data_.get(), geom)) {
      const auto near = std::ranges::find_if(
          candidates, [&](const Candidate& c) { return c.solid->Distance_m(point, c.near_m) <= c.near_m; });
      if (near == candidates.end()) return {};
      if (std::ranges::find(standing, near->solid->geom()) == standing.end()) standing.push_back(near->solid->geom());
      std::rotate(candidates.begin(), near, near + 1);  // the next point is most likely near the same one
    }
    return standing;
  }

  const mjModel* model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  std::vector<Material> materials_;
  std::vector<mjsGeom*> geoms_;
  std::vector<Solid> solids_, floors_;  // all colliding geoms; the floors among those that touch the car
  std::vector<int> grounds_;
};

// Adds a geom that collides in place of another one of the same body. The caller sets its pose and size.
mjsGeom* AddPiece(mjsGeom* of, const std::string& name, const mjsDefault* plain) {
  mjsGeom* piece = mjs_addGeom(mjs_getParent(of->element), plain);
  SetName(piece->element, name);
  piece->contype = of->contype | kMeetsCar, piece->conaffinity = of->conaffinity;
  piece->condim = of->condim, piece->priority = of->priority, piece->solmix = of->solmix;
  std::copy_n(of->friction, 3, piece->friction);
  std::copy_n(of->solref, mjNREF, piece->solref);
  std::copy_n(of->solimp, mjNIMP, piece->solimp);
  piece->group = kPieceGroup;
  piece->mass = 0.0;
  mjs_setString(piece->material, mjs_getString(of->material));
  return piece;
}

void SetPose(const mjModel* alone, int geom, const Eigen::Vector3d& offset, mjsGeom* piece) {
  mjtNum shift[3];
  mju_rotVecQuat(shift, offset.data(), alone->geom_quat + 4 * geom);
  mju_add3(piece->pos, alone->geom_pos + 3 * geom, shift);
  std::copy_n(alone->geom_quat + 4 * geom, 4, piece->quat);
}

// The slab's top is the visible plane.
void AddSlab(const mjModel* alone, int geom, mjsGeom* of, const mjsDefault* plain) {
  mjsGeom* piece = AddPiece(of, GeomName(alone, geom) + kPieceMark + "1", plain);
  piece->type = mjGEOM_BOX;
  piece->size[0] = alone->geom_size[3 * geom], piece->size[1] = alone->geom_size[3 * geom + 1];
  piece->size[2] = 0.5 * kSlab_m;
  SetPose(alone, geom, {0, 0, -0.5 * kSlab_m}, piece);
}

void AddPieces(mjSpec* spec, const mjModel* alone, int geom, const Judge& judge, const mjsDefault* plain,
               const std::vector<std::vector<Eigen::Vector3d>>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (judge.LiesOnFloor(geom, pieces[i])) continue;
    const std::string name = fmt::format("{}{}{}", GeomName(alone, geom), kPieceMark, i + 1);
    mjsMesh* mesh = mjs_addMesh(spec, plain);
    SetName(mesh->element, name);
    std::vector<float> corners;
    for (const Eigen::Vector3d& corner : pieces[i])
      for (int axis = 0; axis < 3; ++axis) corners.push_back(static_cast<float>(corner[axis]));
    mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
    mesh->inertia = mjMESH_INERTIA_SHELL;
    mjsGeom* piece = AddPiece(judge.geoms()[geom], name, plain);
    piece->type = mjGEOM_MESH;
    mjs_setString(piece->meshname, name.c_str());
    SetPose(alone, geom, {0, 0, 0}, piece);
  }
}

void SetContact(const mjModel* alone, int geom, mjsGeom* solid, std::vector<std::string>& warnings) {
  if (std::ranges::any_of(solid->surfacevel, [](double v) { return v != 0.0; }))
    warnings.push_back(fmt::format("geom '{}' has a surfacevel, which this simulation ignores", GeomName(alone, geom)));
  solid->margin = solid->gap = solid->adhesion = 0.0;
  std::ranges::fill(solid->surfacevel, 0.0);
  solid->priority = std::min(solid->priority, kCarPriority - 1);
}

std::string HullWarning(const std::string& name) {
  return fmt::format(
      "mesh geom '{}' collides as its convex hull, with its hollows filled, because it has more than {} convex pieces; "
      "to avoid this, set its contype and conaffinity to 0 and add boxes or convex meshes that collide in its place",
      name, kPiecesMax);
}

std::string Refusal(const std::filesystem::path& room, const std::string& name) {
  const InputError error(room.string(), fmt::format("geom '{}' is seen but cannot be made solid", name),
                         fmt::format("a mesh of at most {} convex pieces, colliding geoms within {:g} cm of all its "
                                     "surface, or a material that is passable",
                                     kPiecesMax, 100 * kStandsFor_m));
  return error.what() + std::string("\n");
}

// Flexes (cloth, soft bodies) that collide touch the car with its contact values, like geoms.
void MarkFlexes(mjSpec* spec) {
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_FLEX); e != nullptr; e = mjs_nextElement(spec, e)) {
    mjsFlex* flex = mjs_asFlex(e);
    flex->margin = flex->gap = 0.0;
    flex->priority = std::min(flex->priority, kCarPriority - 1);
    if (flex->contype != 0 || flex->conaffinity != 0) flex->contype |= kMeetsCar;
  }
}

}  // namespace

SolidRoom MakeSolid(mjSpec* spec, const mjModel* alone, const Materials& materials, const std::filesystem::path& room) {
  const BuiltinDefaults plain;
  Judge judge(spec, alone, materials);
  const std::vector<bool> meets = judge.MeetsCar();
  SolidRoom made;
  for (const int ground : judge.grounds()) made.grounds.push_back(judge.geoms()[ground]);
  std::string refused;
  for (int geom = 0; geom < alone->ngeom; ++geom) {
    if (!meets[geom]) continue;
    mjsGeom* solid = judge.geoms()[geom];
    SetContact(alone, geom, solid, made.warnings);
    if (judge.Panel(geom)) {
      AddSlab(alone, geom, solid, plain.get());
      solid->contype = solid->conaffinity = 0;
      continue;
    }
    const TriangleMesh mesh = alone->geom_type[geom] == mjGEOM_MESH ? MeshOf(alone, geom) : TriangleMesh{};
    if (mesh.triangles.empty() || IsConvex(mesh)) {
      solid->contype |= kMeetsCar;
    } else if (const auto pieces = ConvexPieces(mesh, kPiecesMax)) {
      AddPieces(spec, alone, geom, judge, plain.get(), *pieces);
      solid->contype = solid->conaffinity = 0;
    } else if (Collides(solid)) {
      made.warnings.push_back(HullWarning(GeomName(alone, geom)));
      solid->contype |= kMeetsCar;
    } else {
      refused += Refusal(room, GeomName(alone, geom));
    }
  }
  MarkFlexes(spec);
  if (!refused.empty()) throw InputError(refused.substr(0, refused.size() - 1));
  return made;
}

std::string SeenName(const mjModel* model, int geom) {
  const std::string name = GeomName(model, geom);
  return model->geom_group[geom] == kPieceGroup ? name.substr(0, name.find(kPieceMark)) : name;
}

}  // namespace merlin::sim
