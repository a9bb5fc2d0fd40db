// Measured reflectance: v2 reads Cornell's and MERL's files, v4 those of EPFL's RGL.
#include "core/measured_file.h"
#include "core/pbrt/material_types.h"

#include <utility>

namespace lockstep::pbrt {

namespace {

// The table's number; each file is read once.
int measured_table(const Inputs& in, const std::string& path) {
  Library& library = in.library();
  const auto known = library.measured_files.find(path);
  if (known != library.measured_files.end()) return known->second;
  MeasuredFile file = read_measured_file(path);
  if (!file.warning.empty()) library.warnings.add_line(file.warning, file.warning);
  library.scene_measured.push_back(std::move(file.table));
  return library.measured_files[path] = static_cast<int>(library.scene_measured.size()) - 1;
}

}  // namespace

MadeMaterial measured(const Inputs& in) {
  const ParameterSet& set = in.set();
  const Parameter* file = set.find("filename", {"string"});
  if (file == nullptr || file->strings.size() != 1 || file->strings[0].empty()) {
    fail(set.where(), set.owner() + " needs \"string filename\" with one file");
  }
  const std::string path = resolve(in.library(), set.where().file, file->strings[0]);
  if (in.library().scene_measured.size() == most_measured_tables) {
    fail(set.where(), "more than " + std::to_string(most_measured_tables) +
                          " files of measured reflectance; use fewer");
  }
  return MeasuredMaterial{measured_table(in, path)};
}

}  // namespace lockstep::pbrt
