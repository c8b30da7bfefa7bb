// What several studies need: cameras cropped to a few pixels, single frames, and the laws of the camera's data sheet.
#pragma once

#include <complex>

#include "sim/tof/effects.h"
#include "tools/camera/measure.h"
#include "tools/camera/study.h"

namespace merlin::study {

using Phasor = std::complex<double>;

// These effects on, all others off.
sim::TofEffects Only(std::initializer_list<bool sim::TofEffects::*> on, bool calibrated = true);

// A camera with the same lens and chip that has only the middle of the image, to save time. width, height: in pixels.
DepthCameraSheet Cropped(DepthCameraSheet sheet, int width, int height);

// A camera that has only the middle pixel, and one modulation frequency: the first.
StudyCamera OnePixel(StudyCamera camera);

Shooting ShootingOf(const StudyCamera& camera, const sim::TofEffects& effects, int frames);

// One frame with its truth.
Measurement OneFrame(const StudyCamera& camera, const sim::TofEffects& effects, const sim::TofView& view);

// The measured range of the middle pixels, unwrapped as Measurement says.
double MiddleRange_m(const Measurement& frame);

// Evenly spaced values from one end to the other, both included. LogSteps: evenly spaced in the logarithm.
std::vector<double> Steps(double from, double to, int count);
std::vector<double> LogSteps(double from, double to, int count);

// The signal of a Lambertian surface that the lamp lights: electrons of both taps in one sub-frame, K rho cos(theta) T / d^2
// (K: DepthCameraSheet::signal_e_m2_per_us).
double Signal_e(const StudyCamera& camera, double albedo, double cos_incidence, double range_m);

// Standard deviation of the range of a pixel with two taps and four phases. Source: R. Lange, "3D time-of-flight distance
// measurement with custom solid-state image sensors in CMOS/CCD-technology", PhD thesis, University of Siegen, 2000; here for
// two taps.
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
