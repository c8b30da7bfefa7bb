#include "sim/world/room.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::sim {
namespace {

// MuJoCo's own handler prints, writes a file and exits.
void OnMujocoMessage(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) throw std::runtime_error(std::string("MuJoCo: ") + message->subject);
  // Warnings during a simulation are counted in mjData::warning, which World::Step checks.
}

// "file:12" if the message names a line, else "file".
std::string Where(const std::filesystem::path& file, const std::string& message) {
  std::smatch line;
  const std::regex pattern("line[ =:]*([0-9]+)", std::regex::icase);
  return std::regex_search(message, line, pattern) ? fmt::format("{}:{}", file.string(), line[1].str()) : file.string();
}

std::string OneLine(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

void DrawCurtain(mjSpec* spec, const std::filesystem::path& room, bool closed) {
  std::vector<mjsElement*> curtain;
  for (mjsElement* geom = mjs_firstElement(spec, mjOBJ_GEOM); geom != nullptr; geom = mjs_nextElement(spec, geom))
    if (std::string_view(mjs_getString(mjs_getName(geom))).starts_with("curtain")) curtain.push_back(geom);
  if (closed && curtain.empty())
    throw InputError(room.string(), "the room has no curtain to close", "a geom named curtain*");
  if (closed) return;
  for (mjsElement* geom : curtain)
    if (mjs_delete(spec, geom) != 0) throw std::runtime_error(std::string("MuJoCo: ") + mjs_getError(spec));
}

// Removes the geoms that the custom text leave_out lists.
void LeaveOut(mjSpec* spec, const std::filesystem::path& room) {
  mjsElement* const text = mjs_findElement(spec, mjOBJ_TEXT, "leave_out");
  if (text == nullptr) return;
  std::istringstream names(mjs_getString(mjs_asText(text)->data));
  for (std::string name; names >> name;) {
    mjsElement* const geom = mjs_findElement(spec, mjOBJ_GEOM, name.c_str());
    if (geom == nullptr)
      throw InputError(room.string(), "the text leave_out lists a geom that does not exist", "names of geoms",
                       "'" + name + "'");
    if (mjs_delete(spec, geom) != 0) throw std::runtime_error(std::string("MuJoCo: ") + mjs_getError(spec));
  }
}

// Lets MuJoCo choose the sizes of its arena, contacts and constraints.
void ResetSizes(mjSpec* spec) {
  spec->memory = spec->nstack = -1;
  spec->njmax = spec->nconmax = -1;
}

bool ChangesMasses(const mjsCompiler& compiler) {
  return compiler.boundmass > 0.0 || compiler.boundinertia > 0.0 || compiler.settotalmass > 0.0 ||
         compiler.balanceinertia || compiler.inertiafromgeom != mjINERTIAFROMGEOM_AUTO;
}

void KeepMasses(mjSpec* room, const mjModel* alone) {
  int id = 0;  // the spec lists bodies in the order of their ids, the world first
  for (mjsElement* e = mjs_firstElement(room, mjOBJ_BODY); e != nullptr; e = mjs_nextElement(room, e), ++id) {
    if (alone->body_weldid[id] == 0) continue;
    mjsBody* body = mjs_asBody(e);
    body->mass = alone->body_mass[id];
    std::copy_n(alone->body_ipos + 3 * id, 3, body->ipos);
    std::copy_n(alone->body_iquat + 4 * id, 4, body->iquat);
    std::copy_n(alone->body_inertia + 3 * id, 3, body->inertia);
    mjs_defaultOrientation(&body->ialt);
    std::ranges::fill(body->fullinertia, std::nan(""));
    body->explicitinertial = 1;
  }
}

}  // namespace

void SilenceMujoco() { mju_setLogHandler(OnMujocoMessage); }

InputError RoomError(const std::filesystem::path& room, const std::string& what, const std::string& mujoco_message) {
  return {Where(room, mujoco_message), what + ": " + OneLine(mujoco_message)};
}

SpecPtr ReadRoom(const std::filesystem::path& room, bool curtain_closed) {
  SilenceMujoco();
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(room, unreadable))
    throw InputError(room.string(), "no such room", "an MJCF file");
  char error[1024] = "";
  SpecPtr spec(mj_parseXML(room.c_str(), nullptr, error, sizeof error), mj_deleteSpec);
  if (!spec) throw RoomError(room, "not a room (MJCF)", error);
  DrawCurtain(spec.get(), room, curtain_closed);
  LeaveOut(spec.get(), room);
  return spec;
}

ModelPtr CompileAlone(const std::filesystem::path& room, bool curtain_closed) {
  const SpecPtr spec = ReadRoom(room, curtain_closed);  // mj_copySpec would drop elements with unresolved references
  spec->compiler.fusestatic = spec->compiler.discardvisual = spec->compiler.alignfree = 0;
  ResetSizes(spec.get());
  for (mjsElement* e = mjs_firstElement(spec.get(), mjOBJ_JOINT); e != nullptr; e = mjs_nextElement(spec.get(), e))
    mjs_asJoint(e)->align = mjALIGNFREE_FALSE;
  for (mjsElement* e = mjs_firstElement(spec.get(), mjOBJ_GEOM); e != nullptr; e = mjs_nextElement(spec.get(), e))
    if (mjsGeom* geom = mjs_asGeom(e); geom->type == mjGEOM_MESH) geom->contype = geom->conaffinity = 0;
  ModelPtr model(mj_compile(spec.get(), nullptr), mj_deleteModel);
  if (!model) throw RoomError(room, "the room does not compile", mjs_getError(spec.get()));
  return model;
}

void KeepFromCar(mjSpec* room, const mjModel* alone) {
  if (ChangesMasses(room->compiler)) KeepMasses(room, alone);
  const SpecPtr plain(mj_makeSpec(), mj_deleteSpec);
  mj_defaultOption(&room->option);
  room->compiler.inertiafromgeom = plain->compiler.inertiafromgeom;
  room->compiler.settotalmass = plain->compiler.settotalmass;
  room->compiler.boundmass = plain->compiler.boundmass;
  room->compiler.boundinertia = plain->compiler.boundinertia;
  room->compiler.balanceinertia = plain->compiler.balanceinertia;
  room->compiler.fusestatic = room->compiler.discardvisual = 0;
  ResetSizes(room);
  std::vector<mjsElement*> keys;
  for (mjsElement* e = mjs_firstElement(room, mjOBJ_KEY); e != nullptr; e = mjs_nextElement(room, e)) keys.push_back(e);
  for (mjsElement* key : keys)
    if (mjs_delete(room, key) != 0) throw std::runtime_error(std::string("MuJoCo: ") + mjs_getError(room));
}

std::string GeomName(const mjModel* model, int geom) {
  const char* name = mj_id2name(model, mjOBJ_GEOM, geom);
  return name != nullptr ? name : fmt::format("geom {}", geom);
}

bool IsInside(const mjModel* model, const mjData* data, int geom, const mjtNum point_world[3]) {
  mjtNum offset[3], p[3];
  mju_sub3(offset, point_world, data->geom_xpos + 3 * geom);
  mju_mulMatTVec3(p, data->geom_xmat + 9 * geom, offset);
  const mjtNum* size = model->geom_size + 3 * geom;
  switch (model->geom_type[geom]) {
    case mjGEOM_BOX:
      return std::abs(p[0]) <= size[0] && std::abs(p[1]) <= size[1] && std::abs(p[2]) <= size[2];
    case mjGEOM_SPHERE:
      return mju_norm3(p) <= size[0];
    case mjGEOM_ELLIPSOID:
      return std::hypot(p[0] / size[0], p[1] / size[1], p[2] / size[2]) <= 1.0;
    case mjGEOM_CYLINDER:
      return std::hypot(p[0], p[1]) <= size[0] && std::abs(p[2]) <= size[1];
    case mjGEOM_CAPSULE:
      return std::hypot(p[0], p[1], std::max(0.0, std::abs(p[2]) - size[1])) <= size[0];
    default:
      return false;
  }
}

}  // namespace merlin::sim
