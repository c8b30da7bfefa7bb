#!/usr/bin/env python3
"""Makes the car's visual meshes beside itself: python3 make.py. Needs nothing but Python, and always makes the same bytes.

Every solid is closed and in metres, in its link's frame (x ahead, y left, z up); sizes are those of merlin.urdf. Four
formats on purpose, so that each reader is used: chassis COLLADA, wheel and compass OBJ, mast STL, cameras glTF.
"""
import json
import math
import pathlib
import struct

PAINT, BLACK, ALUMINIUM = (0.72, 0.10, 0.08), (0.08, 0.08, 0.09), (0.70, 0.71, 0.73)
RUBBER, GLASS, DIODE, LAMP, DARK = (0.05, 0.05, 0.05), (0.10, 0.08, 0.20), (0.22, 0.05, 0.10), (0.92, 0.92, 0.85), (0.25, 0.25, 0.27)


# --- Solids: lists of triangles, three points each, counter-clockwise from outside.

def outward(triangles):
    """Turned over if its signed volume is negative."""
    volume = 0.0
    for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in triangles:
        volume += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return triangles if volume > 0 else [(a, c, b) for a, b, c in triangles]


def loft(rings, ring_shaped=False):
    """The skin over rings of equally many points; caps on both ends, or the last joined to the first."""
    triangles, n = [], len(rings[0])
    for i in range(len(rings) if ring_shaped else len(rings) - 1):
        one, two = rings[i], rings[(i + 1) % len(rings)]
        for k in range(n):
            a, b, c, d = one[k], one[(k + 1) % n], two[(k + 1) % n], two[k]
            triangles += [(a, b, c), (a, c, d)]
    if not ring_shaped:
        for ring, turn in ((rings[0], False), (rings[-1], True)):
            for k in range(1, n - 1):
                triangles.append((ring[0], ring[k], ring[k + 1]) if turn else (ring[0], ring[k + 1], ring[k]))
    return outward([t for t in triangles if len(set(t)) == 3])


def octagon(half_u, half_v, cut):
    """A rectangle with its corners cut off."""
    cut = min(cut, 0.95 * half_u, 0.95 * half_v)
    return [(half_u, half_v - cut), (half_u - cut, half_v), (cut - half_u, half_v), (-half_u, half_v - cut),
            (-half_u, cut - half_v), (cut - half_u, -half_v), (half_u - cut, -half_v), (half_u, cut - half_v)]


def block(centre, size, cut=0.003):
    """A box with all its edges cut."""
    (cx, cy, cz), (sx, sy, sz) = centre, size
    cut = min(cut, 0.45 * min(size))
    rings = []
    for x, inset in ((-sx / 2, cut), (-sx / 2 + cut, 0), (sx / 2 - cut, 0), (sx / 2, cut)):
        rings.append([(cx + x, cy + y, cz + z) for y, z in octagon(sy / 2 - inset, sz / 2 - inset, cut)])
    return loft(rings)


def circle(radius, n, start=0.0):
    return [(radius * math.cos(start + 2 * math.pi * k / n), radius * math.sin(start + 2 * math.pi * k / n)) for k in range(n)]


AXES = {"x": lambda u, v, w: (w, u, v), "y": lambda u, v, w: (v, w, u), "z": lambda u, v, w: (u, v, w)}


def turned(profile, axis, centre=(0, 0, 0), n=24):
    """A lathe's work: (radius, place along the axis) from one end to the other, closed by caps."""
    place = AXES[axis]
    rings = [[tuple(c + p for c, p in zip(centre, place(u, v, w))) for u, v in circle(r, n)] for r, w in profile]
    return loft(rings)


def rod(radius, start, end, axis, centre=(0, 0, 0), n=20, cut=0.001):
    return turned([(radius - cut, start), (radius, start + cut), (radius, end - cut), (radius - cut, end)], axis, centre, n)


def moved(solid, x=0.0, y=0.0, z=0.0):
    return [tuple((px + x, py + y, pz + z) for px, py, pz in t) for t in solid]


def turned_about_y(solid, angle):
    c, s = math.cos(angle), math.sin(angle)
    return [tuple((c * x + s * z, y, c * z - s * x) for x, y, z in t) for t in solid]


def mirrored(solid):
    """To the other side, outside still outside."""
    return [tuple((x, -y, z) for x, y, z in (a, c, b)) for a, b, c in solid]


# --- The parts: a list of (colour's name, colour, triangles).

def mudguard(x, inside, steps=14):
    """Over a left wheel of radius 0.055 at (x, 0.13, 0.055), from the body to the tyre's outside, with a lip."""
    section = [(0.067, inside), (0.067, 0.145), (0.062, 0.149), (0.066, 0.150), (0.072, 0.146), (0.073, 0.140), (0.073, inside)]
    rings = []
    for i in range(steps + 1):
        angle = math.radians(18 + (162 - 18) * i / steps)
        rings.append([(x + r * math.cos(angle), y, 0.055 + r * math.sin(angle)) for r, y in section])
    return loft(rings)


def tray():
    """The painted wall round an open tray, thicker at its foot, leaning in at its rim."""
    def outline(grow, z):
        return [(0.088 + u, v, z) for u, v in octagon(0.172 + grow, 0.095 + grow, 0.018 + 0.4 * grow)]
    return loft([outline(0.0, 0.036), outline(0.0, 0.066), outline(-0.005, 0.087), outline(-0.008, 0.087),
                 outline(-0.008, 0.040)], ring_shaped=True)


def nose():
    """Between the front wheels: a bonnet that falls to the front, narrow enough for wheels that steer 30 degrees."""
    rings = []
    for x, half_width, low, high, cut in ((0.258, 0.070, 0.036, 0.088, 0.010), (0.300, 0.070, 0.036, 0.090, 0.014),
                                          (0.350, 0.068, 0.036, 0.086, 0.018), (0.395, 0.064, 0.038, 0.076, 0.018),
                                          (0.418, 0.060, 0.042, 0.066, 0.011)):
        rings.append([(x, u, (low + high) / 2 + v) for u, v in octagon(half_width, (high - low) / 2, cut)])
    return loft(rings)


def bumper():
    """A bar across the front, swept back at its ends."""
    rings = []
    for y, back, front, half in ((-0.140, 0.421, 0.432, 0.010), (-0.120, 0.420, 0.444, 0.014), (-0.070, 0.420, 0.450, 0.015),
                                 (0.070, 0.420, 0.450, 0.015), (0.120, 0.420, 0.444, 0.014), (0.140, 0.421, 0.432, 0.010)):
        rings.append([((back + front) / 2 + u, y, 0.065 + v) for u, v in octagon((front - back) / 2, half, 0.005)])
    return loft(rings)


def chassis():
    paint = tray() + nose()
    for guard in (mudguard(0.0, 0.092), mudguard(0.33, 0.105)):
        paint += guard + mirrored(guard)
    metal = block((0.088, 0, 0.0385), (0.334, 0.176, 0.005), 0.001)
    metal += rod(0.008, -0.11, 0.11, "y", (0, 0, 0.055)) + rod(0.006, -0.11, 0.11, "y", (0.33, 0, 0.055))
    metal += turned([(0.012, -0.024), (0.020, -0.018), (0.020, 0.018), (0.012, 0.024)], "y", (0, 0, 0.055))  # differential
    metal += turned([(0.010, -0.020), (0.016, -0.014), (0.016, 0.014), (0.010, 0.020)], "y", (0.33, 0, 0.050))
    metal += block((0.245, 0, 0.084), (0.06, 0.07, 0.005), 0.001)  # foot of the camera mast
    for side in (-1, 1):  # struts of the front mudguards
        metal += block((0.33, side * 0.088, 0.119), (0.016, 0.05, 0.004), 0.001)
        metal += block((0.33, side * 0.066, 0.104), (0.016, 0.006, 0.034), 0.001)
    dark = bumper() + block((-0.0845, 0, 0.054), (0.011, 0.15, 0.018), 0.003)
    for y in (-0.03, 0.03):  # what carries the bumper
        dark += block((0.415, y, 0.060), (0.020, 0.014, 0.012), 0.002)
    for i in range(4):  # slots of the bonnet
        dark += block((0.305 + 0.012 * i, 0, 0.0895 - 0.0006 * i), (0.005, 0.06, 0.003), 0.001)
    lamps = []
    for y in (-0.045, 0.045):
        lamps += rod(0.0075, 0.395, 0.4125, "x", (0, y, 0.0625), 16, 0.002)
    tail = []
    for y in (-0.066, 0.066):
        tail += block((-0.084, y, 0.0705), (0.010, 0.022, 0.009), 0.002)
    return [("paint", PAINT, paint), ("aluminium", ALUMINIUM, metal), ("plastic", BLACK, dark), ("lamp", LAMP, lamps),
            ("tail_lamp", (0.45, 0.02, 0.02), tail)]


def wheel():
    """Left wheel about y: a tyre with lugs, a rim with a deep dish to the outside (+y) and five forked spokes."""
    segments = 44
    profile = [(0.0365, -0.0165), (0.0415, -0.0185), (0.048, -0.0200), (0.0525, -0.0180), (0.0540, -0.0120), (0.0550, -0.0040),
               (0.0550, 0.0040), (0.0540, 0.0120), (0.0525, 0.0180), (0.048, 0.0200), (0.0415, 0.0185), (0.0365, 0.0165)]
    rings = []
    for k in range(segments):
        angle, groove = 2 * math.pi * k / segments, 0.0016 if k % 2 else 0.0
        ring = []
        for r, y in profile:
            r -= groove if r > 0.052 and abs(y) > 0.005 else 0.0
            ring.append((r * math.sin(angle), y, r * math.cos(angle)))
        rings.append(ring)
    tyre = loft(rings, ring_shaped=True)
    rim_profile = [(0.0335, -0.0175), (0.0385, -0.0185), (0.0385, -0.0150), (0.0370, 0.0), (0.0385, 0.0150), (0.0385, 0.0185),
                   (0.0335, 0.0175), (0.0345, 0.0)]
    rings = []
    for k in range(24):
        angle = 2 * math.pi * k / 24
        rings.append([(r * math.sin(angle), y, r * math.cos(angle)) for r, y in rim_profile])
    metal = loft(rings, ring_shaped=True)
    metal += turned([(0.006, -0.012), (0.009, -0.010), (0.011, 0.004), (0.010, 0.011), (0.007, 0.013)], "y", n=20)
    for k in range(5):
        for fork in (-0.22, 0.22):
            spoke = loft([[(u, 0.006 + v, 0.007) for u, v in octagon(0.0030, 0.0045, 0.001)],
                          [(u, 0.009 + v, 0.036) for u, v in octagon(0.0022, 0.0035, 0.001)]])
            # The fork's two arms meet at the hub and part towards the rim.
            spoke = [tuple((x + fork * (z - 0.007), y, z) for x, y, z in t) for t in spoke]
            metal += turned_about_y(spoke, 2 * math.pi * k / 5)
    nut = turned([(0.0045, 0.012), (0.0045, 0.017), (0.0030, 0.0175)], "y", n=6)
    return [("rubber", RUBBER, tyre), ("rim", ALUMINIUM, metal), ("nut", DARK, nut)]


def mast():
    """Slotted profile of 20 x 30 mm, 230 mm long; brackets to the depth camera before it and the colour camera behind."""
    half = [(0.010, 0.015), (0.010, 0.0035), (0.006, 0.0035), (0.006, -0.0035), (0.010, -0.0035), (0.010, -0.015)]
    bottom = [(0.0035, -0.015), (0.0035, -0.011), (-0.0035, -0.011), (-0.0035, -0.015)]
    outline = half + bottom + [(-x, -y) for x, y in half + bottom]
    flange = [(0.0, 0.0)]  # the outline is no convex shape: its caps are fans about the middle
    solid, n = [], len(outline)
    for k in range(n):
        (ax, ay), (bx, by) = outline[k], outline[(k + 1) % n]
        solid += [((ax, ay, -0.115), (bx, by, -0.115), (bx, by, 0.115)), ((ax, ay, -0.115), (bx, by, 0.115), (ax, ay, 0.115))]
        for z in (-0.115, 0.115):
            (mx, my) = flange[0]
            solid.append(((mx, my, z), (ax, ay, z), (bx, by, z)) if z > 0 else ((mx, my, z), (bx, by, z), (ax, ay, z)))
    solid = outward(solid)
    for side in (-1, 1):  # gussets at the foot
        solid += loft([[(x, side * y, z) for x, z in ((-0.028, -0.115), (0.028, -0.115), (0.010, -0.075), (-0.010, -0.075))]
                       for y in (0.015, 0.019)])
    solid += block((-0.005, 0, 0.1475), (0.034, 0.040, 0.065), 0.003)      # plate behind the depth camera, clamped on top
    solid += block((-0.030, 0.004, 0.1825), (0.055, 0.036, 0.010), 0.002)  # shelf to the rear
    solid += block((-0.046, 0.008, 0.1905), (0.044, 0.030, 0.014), 0.002)  # cradle of the colour camera
    for y in (-0.012, 0.012):
        for z in (0.130, 0.165):
            solid += rod(0.003, -0.025, -0.021, "x", (0, y, z), 6, 0.0005)
    return solid


def depth_camera():
    """Housing 60 x 160 x 65 mm, lens in the middle, a field of infrared diodes on either side, ribs behind."""
    body = block((-0.004, 0, 0), (0.044, 0.160, 0.065), 0.004)
    for i in range(9):
        body += block((-0.027, -0.064 + 0.016 * i, 0), (0.006, 0.004, 0.056), 0.001)
    body += turned([(0.0205, 0.016), (0.0205, 0.021), (0.0185, 0.023)], "x", (0, 0, 0.0025), 28)
    front = []
    for side in (-1, 1):
        front += block((0.020, side * 0.051, 0), (0.010, 0.050, 0.057), 0.002)
    front += turned([(0.0165, 0.018), (0.0165, 0.0285), (0.0150, 0.030), (0.0110, 0.030), (0.0095, 0.026)], "x", (0, 0, 0.0025), 28)
    diodes = []
    for side in (-1, 1):
        for row in range(5):
            for column in range(4):
                centre = (0, side * (0.0345 + 0.011 * column), -0.022 + 0.011 * row)
                diodes += turned([(0.0042, 0.0245), (0.0028, 0.0285)], "x", centre, 6)
    glass = turned([(0.0100, 0.024), (0.0100, 0.0262), (0.0060, 0.0275), (0.0010, 0.0282)], "x", (0, 0, 0.0025), 24)
    return [("housing", ALUMINIUM, body), ("front", BLACK, front), ("diodes", DIODE, diodes), ("lens", GLASS, glass)]


def color_camera():
    """A small CCD camera: 40 x 40 mm, lens with a knurled ring in front, plug behind."""
    body = block((-0.0085, 0, 0), (0.038, 0.040, 0.040), 0.003)
    body += turned([(0.0145, 0.0100), (0.0145, 0.0130), (0.0125, 0.0140)], "x", (0, 0, 0), 24)
    ring = loft([[(x, (0.0128 if k % 2 else 0.0134) * math.cos(k * math.pi / 16), (0.0128 if k % 2 else 0.0134) * math.sin(k * math.pi / 16))
                  for k in range(32)] for x in (0.0140, 0.0215)])
    ring += turned([(0.0120, 0.0215), (0.0120, 0.0265), (0.0110, 0.0275), (0.0090, 0.0275), (0.0075, 0.0245)], "x", (0, 0, 0), 24)
    plug = rod(0.006, -0.0275, -0.026, "x", (0, 0.008, -0.006), 12, 0.0005)
    glass = turned([(0.0080, 0.0230), (0.0080, 0.0250), (0.0045, 0.0262), (0.0008, 0.0268)], "x", (0, 0, 0), 20)
    return [("housing", DARK, body), ("ring", BLACK, ring + plug), ("lens", GLASS, glass)]


def compass():
    """MicroStrain 3DM, 65 x 65 x 24 mm, on a rod of 20 cm with a foot and four screws."""
    metal = rod(0.006, -0.145, 0.055, "z", (0, 0, 0))
    metal += turned([(0.020, -0.145), (0.020, -0.141), (0.011, -0.138), (0.0085, -0.125), (0.006, -0.123)], "z", (0, 0, 0))
    metal += block((0, 0, 0.0555), (0.060, 0.060, 0.004), 0.001)
    housing = block((0, 0, 0.0685), (0.065, 0.065, 0.021), 0.004)
    screws, label = [], block((0.0, 0.0, 0.0788), (0.040, 0.026, 0.001), 0.0003)
    for x in (-0.026, 0.026):
        for y in (-0.026, 0.026):
            screws += rod(0.003, 0.0775, 0.0800, "z", (x, y, 0), 8, 0.0005)
    screws += rod(0.005, -0.0345, -0.031, "x", (0, 0.012, 0.068), 12, 0.0005)  # plug
    return [("rod", ALUMINIUM, metal), ("housing", (0.12, 0.13, 0.16), housing), ("screws", DARK, screws), ("label", LAMP, label)]


# --- Files.

def number(value):
    text = ("%.6f" % value).rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def indexed(triangles):
    """Points without repetition, and three places a triangle."""
    places, points, corners = {}, [], []
    for triangle in triangles:
        for point in triangle:
            key = tuple(number(v) for v in point)
            if key not in places:
                places[key] = len(points)
                points.append(key)
            corners.append(places[key])
    return points, corners


def write_obj(path, parts):
    lines, materials, first = ["mtllib %s.mtl" % path.stem], [], 1
    for name, color, triangles in parts:
        points, corners = indexed(triangles)
        materials += ["newmtl " + name, "Kd " + " ".join(map(number, color))]
        lines += ["usemtl " + name] + ["v " + " ".join(p) for p in points]
        lines += ["f %d %d %d" % tuple(first + c for c in corners[i:i + 3]) for i in range(0, len(corners), 3)]
        first += len(points)
    path.write_text("\n".join(lines) + "\n")
    path.with_suffix(".mtl").write_text("\n".join(materials) + "\n")


def write_stl(path, triangles):
    data = b"Mast of merlin".ljust(80) + struct.pack("<I", len(triangles))
    for triangle in triangles:
        data += struct.pack("<12fH", 0, 0, 0, *(v for point in triangle for v in point), 0)
    path.write_bytes(data)


def write_dae(path, parts):
    effects, materials, geometries, nodes = "", "", "", ""
    for name, color, triangles in parts:
        points, corners = indexed(triangles)
        effects += ('<effect id="%s_effect"><profile_COMMON><technique sid="common"><lambert><diffuse><color>%s 1</color></diffuse>'
                    '</lambert></technique></profile_COMMON></effect>\n') % (name, " ".join(map(number, color)))
        materials += '<material id="%s" name="%s"><instance_effect url="#%s_effect"/></material>\n' % (name, name, name)
        geometries += ('<geometry id="%s_mesh"><mesh><source id="%s_p"><float_array id="%s_a" count="%d">%s</float_array><technique_common>'
                       '<accessor source="#%s_a" count="%d" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
                       '<param name="Z" type="float"/></accessor></technique_common></source><vertices id="%s_v"><input semantic="POSITION" '
                       'source="#%s_p"/></vertices><triangles count="%d" material="m"><input semantic="VERTEX" source="#%s_v" offset="0"/>'
                       '<p>%s</p></triangles></mesh></geometry>\n') % (
            name, name, name, 3 * len(points), " ".join(" ".join(p) for p in points), name, len(points), name, name,
            len(corners) // 3, name, " ".join(map(str, corners)))
        nodes += ('<node id="%s_node"><instance_geometry url="#%s_mesh"><bind_material><technique_common><instance_material symbol="m" '
                  'target="#%s"/></technique_common></bind_material></instance_geometry></node>\n') % (name, name, name)
    path.write_text(
        '<?xml version="1.0" encoding="utf-8"?>\n<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">\n'
        '<asset><unit name="metre" meter="1"/><up_axis>Z_UP</up_axis></asset>\n<library_effects>\n%s</library_effects>\n'
        '<library_materials>\n%s</library_materials>\n<library_geometries>\n%s</library_geometries>\n<library_visual_scenes>'
        '<visual_scene id="scene">\n%s</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url="#scene"/></scene>\n'
        '</COLLADA>\n' % (effects, materials, geometries, nodes))


def write_glb(path, parts):
    """y is up in glTF: (x, y, z) is written (x, z, -y)."""
    tree = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": []}], "materials": [], "accessors": [], "bufferViews": []}
    data = b""
    for name, color, triangles in parts:
        points, corners = indexed(triangles)
        points = [(float(x), float(z), -float(y)) for x, y, z in points]
        points = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in points]
        views = [b"".join(struct.pack("<3f", *p) for p in points), b"".join(struct.pack("<I", c) for c in corners)]
        place = len(tree["accessors"])
        for view in views:
            tree["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(view)})
            data += view
        tree["accessors"] += [
            {"bufferView": place, "componentType": 5126, "count": len(points), "type": "VEC3",
             "min": [min(p[i] for p in points) for i in range(3)], "max": [max(p[i] for p in points) for i in range(3)]},
            {"bufferView": place + 1, "componentType": 5125, "count": len(corners), "type": "SCALAR"}]
        tree["meshes"][0]["primitives"].append(
            {"attributes": {"POSITION": place}, "indices": place + 1, "material": len(tree["materials"])})
        tree["materials"].append({"name": name, "pbrMetallicRoughness": {"baseColorFactor": list(color) + [1.0]}})
    tree["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(b"glTF" + struct.pack("<III", 2, 28 + len(text) + len(data), len(text)) + b"JSON" + text +
                     struct.pack("<I", len(data)) + b"BIN\0" + data)


def main():
    here = pathlib.Path(__file__).resolve().parent
    write_dae(here / "chassis.dae", chassis())
    write_obj(here / "wheel.obj", wheel())
    write_stl(here / "camera_mast.stl", mast())
    write_glb(here / "depth_camera.glb", depth_camera())
    write_glb(here / "color_camera.glb", color_camera())
    write_obj(here / "compass_mast.obj", compass())


if __name__ == "__main__":
    main()
