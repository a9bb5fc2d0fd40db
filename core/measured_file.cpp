#include "core/measured_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace lockstep {
namespace {

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Measurements may return more light than there was; that is no reason to alter them.
std::string energy_warning(const std::string& path, const MeasuredTable& table) {
  const MeasuredAlbedo albedo = largest_albedo(table);
  if (albedo.largest <= 1.01) return {};
  return fmt::format(
      "{}: reflects {:.0f} % of the light that arrives at {:.0f} degrees, more than there is; it "
      "is used as measured",
      path, 100.0 * albedo.largest, albedo.degrees);
}

}  // namespace

MeasuredFile read_measured_file(const std::string& path) {
  MeasuredFile file;
  const std::string extension = lower_extension(path);
  if (extension == ".bsdf") {
    RglCells rgl = read_rgl(path);
    file.table = make_measured_table(std::move(rgl.cells), path);
    if (!rgl.isotropic) {
      file.warning = path + ": is anisotropic; the mean over all orientations is used";
    }
  } else {
    const bool text = extension == ".brdf";
    file.table = make_measured_table(text ? read_measured_samples(path) : read_merl(path), path);
  }
  if (file.warning.empty()) file.warning = energy_warning(path, file.table);
  return file;
}

}  // namespace lockstep
