// What the studies share: cameras that look at little, one frame without noise, the sheet's laws.
#pragma once

#include <complex>

#include "sim/tof/effects.h"
#include "tools/camera/measure.h"
#include "tools/camera/study.h"

namespace merlin::study {

using Phasor = std::complex<double>;

// No effect but these.
sim::TofEffects Only(std::initializer_list<bool sim::TofEffects::*> on, bool calibrated = true);

// The middle of the picture alone, this many pixels wide and high: same lens and chip, less to compute.
DepthCameraSheet Cropped(DepthCameraSheet sheet, int width, int height);

// The camera's middle pixel alone, at its first modulation frequency.
StudyCamera OnePixel(StudyCamera camera);

Shooting ShootingOf(const StudyCamera& camera, const sim::TofEffects& effects, int frames);

// One frame, and what the truth says of it.
Measurement OneFrame(const StudyCamera& camera, const sim::TofEffects& effects, const sim::TofView& view);

double MiddleRange_m(const Measurement& frame);  // measured, unwrapped about the truth and less the centre's wraps

// Evenly spaced, ends included; the second in the logarithm.
std::vector<double> Steps(double from, double to, int count);
std::vector<double> LogSteps(double from, double to, int count);

// A Lambertian surface seen from the lamp: electrons of both taps in one sub-frame, K rho cos(theta) T / d^2.
double Signal_e(const StudyCamera& camera, double albedo, double cos_incidence, double range_m);

// Standard deviation of range of the two-tap, four-phase pixel (R. Lange, PhD thesis, Siegen 2000, for two taps).
double SigmaLaw_m(const StudyCamera& camera, double signal_e, double background_e);

double Phase_rad(const StudyCamera& camera, double range_m);
double RangeOf_m(const StudyCamera& camera, double phase_rad);

// The studies.
Figure Noise(const StudyCamera& camera);
Figure Integration(const StudyCamera& camera);
Figure SunStudy(const StudyCamera& camera);
Figure Wiggling(const StudyCamera& camera);
Figure Motion(const StudyCamera& camera);
Figure Flying(const StudyCamera& camera);
Figure Glass(const StudyCamera& camera);
Figure Scatter(const StudyCamera& camera);
Figure Multipath(const StudyCamera& camera);

}  // namespace merlin::study
