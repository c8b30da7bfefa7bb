// Mesh files written by hand for tests: the same box in every format, and in many invalid forms.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace merlin::mesh_text {

struct Box {
  double x = 1.0, y = 2.0, z = 3.0;  // full edges about the origin
};

// Corner i has +x, +y, +z where bits 0, 1, 2 of i are set; triangles counter-clockwise from outside.
inline std::array<double, 3> Corner(const Box& box, int i) {
  return {(i & 1 ? 0.5 : -0.5) * box.x, (i & 2 ? 0.5 : -0.5) * box.y, (i & 4 ? 0.5 : -0.5) * box.z};
}
constexpr int kTriangles[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

inline std::string Obj(const Box& box) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("v {} {} {}\n", Corner(box, i)[0], Corner(box, i)[1], Corner(box, i)[2]);
  for (const auto& t : kTriangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

inline std::string StlText(const Box& box) {
  std::string text = "solid box\n";
  for (const auto& t : kTriangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : t)
      text += fmt::format("vertex {} {} {}\n", Corner(box, i)[0], Corner(box, i)[1], Corner(box, i)[2]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

template <class T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string StlBinary(const Box& box, std::uint32_t claimed = 12) {
  std::string bytes(80, ' ');
  Append(bytes, claimed);
  for (const auto& t : kTriangles) {
    for (int i = 0; i < 3; ++i) Append(bytes, 0.0f);
    for (const int i : t)
      for (const double number : Corner(box, i)) Append(bytes, static_cast<float>(number));
    Append(bytes, std::uint16_t{0});
  }
  return bytes;
}

struct Collada {
  Box box{};
  std::string up = "Z_UP";
  double unit_m = 1.0;
  std::string claimed = "24";  // numbers in the array
  std::string color = "0.2 0.4 0.6 1";
};

inline std::string Dae(const Collada& file) {
  std::string numbers, corners;
  for (int i = 0; i < 8; ++i)
    for (const double number : Corner(file.box, i)) numbers += fmt::format("{} ", number);
  for (const auto& t : kTriangles) corners += fmt::format("{} {} {} ", t[0], t[1], t[2]);
  return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit meter="{}"/><up_axis>{}</up_axis></asset>
 <library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert>
  <diffuse><color>{}</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
 <library_materials><material id="m" name="m"><instance_effect url="#e"/></material></library_materials>
 <library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="a" count="{}">{}</float_array>
   <technique_common><accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
   <param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="12" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>{}</p></triangles>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"><bind_material><technique_common>
  <instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
 </library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)",
                     file.unit_m, file.up, file.color, file.claimed, numbers, corners);
}

struct Gltf {
  Box box{};                  // x right, y up, z to the front
  std::string claimed = "8";  // vertices
};

// The buffer of a box: 8 corners, 36 places.
inline std::string GltfBuffer(const Box& box) {
  std::string bytes;
  for (int i = 0; i < 8; ++i)
    for (const double number : Corner(box, i)) Append(bytes, static_cast<float>(number));
  for (const auto& t : kTriangles)
    for (const int i : t) Append(bytes, static_cast<std::uint16_t>(i));
  return bytes;
}

inline std::string GltfJson(const Gltf& file, const std::string& buffer) {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
"materials":[{{"name":"m","pbrMetallicRoughness":{{"baseColorFactor":[0.2,0.4,0.6,1]}}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},
{{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
"buffers":[{{{}"byteLength":168}}]}})",
      file.claimed, -file.box.x / 2, -file.box.y / 2, -file.box.z / 2, file.box.x / 2, file.box.y / 2, file.box.z / 2,
      buffer);
}

inline std::string Glb(const Gltf& file) {
  std::string json = GltfJson(file, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = GltfBuffer(file.box);
  std::string bytes = "glTF";
  Append(bytes, std::uint32_t{2});
  Append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  Append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  Append(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

}  // namespace merlin::mesh_text
