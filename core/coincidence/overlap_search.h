// Overlaps among triangles that may lie in one plane.
#pragma once

#include "core/coincidence/entries.h"
#include "core/coincidence/unit_mesh.h"

namespace lockstep::coincidence {

// A triangle of a group: its extent in two dimensions.
struct Box {
  double u_low, u_high, v_low, v_high;
  std::uint32_t triangle;
};

// The boxes of a group that is searched pair by pair, as the caller's coordinates state them: boxes
// apart here are so in unit coordinates, too.
struct SmallBoxes {
  static constexpr std::size_t most = 128;
  float u_low[most] = {}, u_high[most] = {}, v_low[most] = {}, v_high[most] = {};
};

struct Strips;

// Finds the overlaps in groups of triangles whose planes may be the same. Several searches may
// share their flags: those that are set do not depend on the order.
class OverlapSearch {
 public:
  OverlapSearch(const UnitMesh& mesh, std::vector<std::uint8_t>& flags)
      : mesh_(mesh), flags_(flags) {}

  // Sets the flags of the triangles of `group` that overlap another one of it, seen along `axis`.
  void search(std::span<const Entry> group, std::size_t axis);

 private:
  void search_pairs(std::span<const Entry> group);
  void sweep(const Strips& strips);
  void test(std::uint32_t a, std::uint32_t b);

  const UnitMesh& mesh_;
  std::vector<std::uint8_t>& flags_;
  std::size_t axis_ = 0;
  SmallBoxes small_;
  std::vector<Box> boxes_;
  std::vector<Entry> order_, scratch_;
};

}  // namespace lockstep::coincidence
