// Studies of stray light: multipath between two walls, and scatter between lens and chip.
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tools/camera/study_parts.h"

namespace merlin::study {
namespace {

// Two walls at a right angle. Their common edge lies on the optical axis, which bisects the angle.
struct Corner {
  double distance_m;

  struct Point {
    Eigen::Vector3d position, normal;
    int wall;
  };
  // Where a ray from the origin meets it.
  Point Meet(const Eigen::Vector3d& ray) const {
    const int wall = ray.y() > 0.0 ? 0 : 1;
    const Eigen::Vector3d normal = Eigen::Vector3d(-1.0, wall == 0 ? -1.0 : 1.0, 0.0) / std::numbers::sqrt2;
    const double range_m = -distance_m / std::numbers::sqrt2 / normal.dot(ray);
    return {range_m * ray, normal, wall};
  }
};

Stage CornerStage(double distance_m, double albedo) {
  // Boxes of 20 x 20 m behind the two surfaces: half length l along the wall, half thickness h.
  constexpr double kLength_m = 10.0, kThickness_m = 0.1;
  const double along = kLength_m / std::numbers::sqrt2, behind = kThickness_m / std::numbers::sqrt2;
  return BuildStage(fmt::format("<geom type='box' size='{0} {1} {0}' pos='{2} {3} 0' euler='0 0 {4}'/><geom type='box' "
                                "size='{0} {1} {0}' pos='{2} {5} 0' euler='0 0 {6}'/>",
                                kLength_m, kThickness_m, distance_m - along + behind, along + behind,
                                0.75 * std::numbers::pi, -along - behind, 0.25 * std::numbers::pi),
                    {{.nir_albedo = albedo}, {.nir_albedo = albedo}});
}

Eigen::Vector3d RayBody(const CameraModel& camera, double u, double v) {
  return BodyOptical().linear() * camera.Ray(u, v);
}

// One bounce: the lamp at the lens lights the field of view uniformly, and each point that it hits lights the other
// wall.
double Bulge_m(const StudyCamera& camera, const Corner& corner, double albedo, double u, double v) {
  const CameraModel& lens = camera.sheet.camera;
  const Corner::Point p = corner.Meet(RayBody(lens, u, v));
  const double d_p = p.position.norm();
  Phasor sum = std::polar(-p.normal.dot(p.position) / (d_p * d_p * d_p), Phase_rad(camera, d_p));
  constexpr int kColumns = 320, kRows = 240;
  const double du = static_cast<double>(lens.width) / kColumns, dv = static_cast<double>(lens.height) / kRows;
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kRows; ++j) {
      const double a = (i + 0.5) * du - 0.5, b = (j + 0.5) * dv - 0.5;
      const Eigen::Vector3d ray = RayBody(lens, a, b);
      const Corner::Point q = corner.Meet(ray);
      if (q.wall == p.wall) continue;
      const double solid_angle = du * dv / (lens.fx_px * lens.fy_px) * std::pow(ray.x(), 3.0);  // x: cosine to the axis
      const Eigen::Vector3d to_p = p.position - q.position;
      const double r = to_p.norm(), cos_q = q.normal.dot(to_p) / r, cos_p = -p.normal.dot(to_p) / r;
      if (cos_q <= 0.0 || cos_p <= 0.0) continue;
      sum += std::polar(albedo / std::numbers::pi * solid_angle * cos_q * cos_p / (r * r),
                        Phase_rad(camera, 0.5 * (q.position.norm() + r + d_p)));
    }
  return RangeOf_m(camera, std::arg(sum * std::polar(1.0, -Phase_rad(camera, d_p))));
}

}  // namespace

Figure Multipath(const StudyCamera& of) {
  constexpr double kAlbedo = 0.7;
  StudyCamera camera = of;
  camera.settings.second_frequency_hz = 0.0;
  const CameraModel& lens = camera.sheet.camera;
  Panel panel{.x = {"angle to the corner's edge [deg]"}, .y = {"measured less true range [mm]"}};
  int color = 0;
  for (const double distance_m : {1.0, 2.0, 3.0, 4.0}) {
    const Measurement frame =
        OneFrame(camera, Only({&sim::TofEffects::multipath}), CornerStage(distance_m, kAlbedo).View());
    Series law{.name = fmt::format("quadrature, corner at {:g} m", distance_m), .color = color};
    Series dots{.name = "samples", .dots = true, .color = color++};
    const int row = lens.height / 2, step = std::max(1, lens.width / 32);
    for (int u = 0; u < lens.width; u += step) {
      const double angle_deg = std::atan((u - lens.cx_px) / lens.fx_px) * 180.0 / std::numbers::pi;
      const auto p = static_cast<std::size_t>(row * lens.width + u);
      const double error_m =
          UnwrapNear(frame.last.range_m[p] - frame.truth.range_m[p], 0.0, UnambiguousRange_m(camera.settings));
      dots.Add(angle_deg, 1e3 * error_m);
      law.Add(angle_deg, 1e3 * Bulge_m(camera, {distance_m}, kAlbedo, u, row));
    }
    panel.series.push_back(law);
    panel.series.push_back(dots);
  }
  return {"multipath: a corner of two walls bulges",
          fmt::format("middle row, albedo {:g}, {:g} MHz; line: one bounce from 76,800 directions of the lamp", kAlbedo,
                      camera.settings.frequency_hz * 1e-6),
          {panel}};
}

Figure Scatter(const StudyCamera& of) {
  constexpr double kPlate_m = 0.5, kPlateAlbedo = 0.9, kShare = 0.02;
  StudyCamera camera = of;
  camera.settings.second_frequency_hz = 0.0;
  camera.errors.scatter_share = kShare;
  const CameraModel& lens = camera.sheet.camera;
  const int row = lens.height / 2, column = lens.width * 9 / 10;  // far from the plate
  const auto pixel = static_cast<std::size_t>(row * lens.width + column);
  struct Target {
    double distance_m, albedo;
  };
  Panel panel{.x = {"share of the view that a near bright plate covers"}, .y = {"measured less true range [mm]"}};
  int color = 0;
  for (const Target& wall : {Target{2.0, 0.5}, Target{3.0, 0.1}}) {
    Series law{.name = fmt::format("law: wall at {:g} m, albedo {:g}", wall.distance_m, wall.albedo), .color = color};
    Series dots{.name = "samples", .dots = true, .color = color++};
    for (int covered = 0; covered <= lens.width / 2; covered += std::max(1, lens.width / 32)) {
      const double share = static_cast<double>(covered) / lens.width;
      // The plate covers the columns below this one.
      const auto facing = [&](double u, double v) {
        const bool plate = u < covered - 0.5;
        const double z_m = plate ? kPlate_m : wall.distance_m, cosine = lens.Ray(u, v).z(), range_m = z_m / cosine;
        return std::polar((plate ? kPlateAlbedo : wall.albedo) * cosine / (range_m * range_m),
                          Phase_rad(camera, range_m));
      };
      Phasor mean = 0.0;
      for (int v = 0; v < lens.height; ++v)
        for (int u = 0; u < lens.width; ++u) mean += facing(u, v) / static_cast<double>(lens.width * lens.height);
      // In this area the Gaussian part changes nothing; the uniform part adds the mean of the image.
      const double even = kShare * camera.errors.scatter_flat, range_m = wall.distance_m / lens.Ray(column, row).z();
      const Phasor sum = (1.0 - even) * facing(column, row) + even * mean;
      law.Add(share, 1e3 * RangeOf_m(camera, std::arg(sum * std::polar(1.0, -Phase_rad(camera, range_m)))));

      // Left in the picture is +y; the plate's right edge lies between two columns.
      const double edge_m = -(covered - 0.5 - lens.cx_px) / lens.fx_px * kPlate_m;
      const Stage stage = BuildStage(
          fmt::format(
              "<geom type='box' size='.0005 2 2' pos='{} {} 0'/><geom type='box' size='.05 20 20' pos='{} 0 0'/>",
              kPlate_m + 0.0005, edge_m + 2.0, wall.distance_m + 0.05),
          {{.nir_albedo = kPlateAlbedo}, {.nir_albedo = wall.albedo}});
      const Measurement frame = OneFrame(camera, Only({&sim::TofEffects::scatter}), stage.View());
      dots.Add(share, 1e3 * UnwrapNear(frame.last.range_m[pixel] - range_m, 0.0, UnambiguousRange_m(camera.settings)));
    }
    panel.series.push_back(law);
    panel.series.push_back(dots);
  }
  return {"scatter in the camera: a near bright plate pulls what is beside it",
          fmt::format("{:g} of the light is scattered, {:g} of that evenly; plate at {:g} m, albedo {:g}; {:g} MHz",
                      kShare, camera.errors.scatter_flat, kPlate_m, kPlateAlbedo, camera.settings.frequency_hz * 1e-6),
          {panel}};
}

}  // namespace merlin::study
