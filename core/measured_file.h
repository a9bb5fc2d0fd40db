// Files of measured reflectance, as tables for the kernels.
//
// .brdf: text of Cornell's Program of Computer Graphics, with comments behind '#': the number of
// wavelengths, these in nm, then per measurement theta and phi of the light and of the viewer in
// radians and a value per wavelength, in 1/sr. Such samples are few and lie where the instrument
// went; between them the file's own author (pbrt-v2) takes the mean of those within a distance of
// (sin_i sin_o, |phi_i - phi_o| / pi, cos_i cos_o), weighted by exp(-100 distance^2). In these
// coordinates wo and wi may be swapped: measurements of both are averaged.
//
// .binary: MERL's tables (Matusik et al. 2003), 90 x 90 x 180 cells of theta_half,
// theta_difference and phi_difference, each a double per channel; negative: no data.
//
// .bsdf: RGL's materials (Dupuy and Jakob 2018), tensors in an adaptive parameterisation, as RGB or
// spectra. Of anisotropic ones the mean over all orientations is taken.
#pragma once

#include "core/measured_table.h"

#include <string>

namespace lockstep {

struct MeasuredFile {
  MeasuredTable table;
  std::string warning;  // one line, or empty
};

// By the name's extension: .brdf is text, .bsdf RGL's, all else MERL's. Throws Error, one line that
// begins with the path, where the file is missing, cut short or malformed, has counts that do not
// fit, more than 8192 measurements, or values that are not finite; and where it is of another
// format that is known by its first bytes.
MeasuredFile read_measured_file(const std::string& path);

// core/measured_samples.cpp, core/merl.cpp and core/rgl.cpp: one format each.
MeasuredCells read_measured_samples(const std::string& path);
MeasuredCells read_merl(const std::string& path);
struct RglCells {
  MeasuredCells cells;
  bool isotropic = true;
};
RglCells read_rgl(const std::string& path);

}  // namespace lockstep
