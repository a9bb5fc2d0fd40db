// Building blocks of kernels: time per lane by width, for independent packets one after the other.
#include "bench_lanes.h"
#include "bench_main.h"
#include "core/frame.h"
#include "core/simd_bits.h"
#include "core/simd_math.h"
#include "core/simd_pack.h"

#include <memory>

namespace lockstep {
namespace {

constexpr int table_rows = 256;  // of four floats: 4 KiB, in cache like the inputs

struct alignas(64) Arrays {
  FloatLanes x, y, z, w;
  UIntLanes bits;
  IntLanes row;
  float table[4 * table_rows];
  float sums[4 * lane_count];
  FloatLanes out[6];
  UIntLanes out_bits;
};

std::unique_ptr<Arrays> make_arrays() {
  auto a = std::make_unique<Arrays>();
  for (int i = 0; i < lane_count; ++i) {
    const Vec3<float> v(uniform(i, 0) - 0.5f, uniform(i, 1) - 0.5f, uniform(i, 2) + 0.1f);
    const Vec3<float> unit = normalize(v);
    a->x[i] = unit.x, a->y[i] = unit.y, a->z[i] = unit.z;
    a->w[i] = uniform(i, 3);
    a->bits[i] = pcg3d(std::uint32_t(i), 4u, seed).x;
    a->row[i] = 4 * std::int32_t(a->bits[i] % table_rows);
  }
  for (int i = 0; i < 4 * table_rows; ++i) a->table[i] = uniform(i, 5);
  return a;
}

template <int W>
LOCKSTEP_INLINE Vec3<Float<W>> vector_at(const Arrays& a, int i) {
  using V = Float<W>;
  return {load<V>(a.x + i), load<V>(a.y + i), load<V>(a.z + i)};
}

template <class V>
LOCKSTEP_INLINE void write(Arrays& a, int first, int i, const Vec3<V>& v) {
  store(a.out[first] + i, v.x);
  store(a.out[first + 1] + i, v.y);
  store(a.out[first + 2] + i, v.z);
}

// What the loads, stores and the loop cost that the others have too.
struct Copy {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    store(a.out[0] + i, load<Float<W>>(a.x + i));
  }
};

struct SquareRoot {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    store(a.out[0] + i, sqrt(load<Float<W>>(a.w + i)));
  }
};

struct Division {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    store(a.out[0] + i, load<Float<W>>(a.w + i) / load<Float<W>>(a.z + i));
  }
};

struct SincosTurns {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const auto r = sincos_turns(load<Float<W>>(a.w + i));
    store(a.out[0] + i, r.sin);
    store(a.out[1] + i, r.cos);
  }
};

struct Normalize {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    write(a, 0, i, normalize(vector_at<W>(a, i)));
  }
};

struct FrameAround {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const auto frame = frame_around(vector_at<W>(a, i));
    write(a, 0, i, frame.x);
    write(a, 3, i, frame.y);
  }
};

struct Pcg4d {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    using U = UInt<W>;
    const Hash4<U> h = pcg4d(load<U>(a.bits + i), U(1u), U(2u), U(seed));
    store(a.out_bits + i, h.x ^ h.y ^ h.z ^ h.w);
  }
};

struct ReverseBits {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    store(a.out_bits + i, reverse_bits(load<UInt<W>>(a.bits + i)));
  }
};

// Four values per lane: side by side in four arrays, ...
struct FourLoads {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const Vec3<Float<W>> v = vector_at<W>(a, i);
    store(a.out[0] + i, v.x + v.y + v.z + load<Float<W>>(a.w + i));
  }
};

// ... from a row of the table that differs by lane, element by element, ...
struct FourGathers {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const Int<W> row = load<Int<W>>(a.row + i);
    store(a.out[0] + i, gather(a.table, row) + gather(a.table + 1, row) + gather(a.table + 2, row) +
                            gather(a.table + 3, row));
  }
};

// ... and from the same row as a whole.
struct GatherRows {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const auto r = gather_rows(static_cast<const float*>(a.table), load<Int<W>>(a.row + i));
    store(a.out[0] + i, r.x + r.y + r.z + r.w);
  }
};

// Four values per lane added to a row of its own.
struct AddRows {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    using V = Float<W>;
    const Vec3<V> v = vector_at<W>(a, i);
    add_rows(a.sums, Int<W>(i) + lane_indices<W>(), {v.x, v.y, v.z, V(1.0f)}, Mask<W>(true));
  }
};

// Four arrays by one mask, in which half of the lanes are set.
struct PackFour {
  int n = 0;

  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    using V = Float<W>;
    const V w = load<V>(a.w + i);
    const Packing<W> lanes(w < V(0.5f));
    lanes.store(a.out[0] + n, load<V>(a.x + i));
    lanes.store(a.out[1] + n, load<V>(a.y + i));
    lanes.store(a.out[2] + n, load<V>(a.z + i));
    lanes.store(a.out[3] + n, w);
    n += lanes.count();
  }
};

void register_all() {
  static const std::unique_ptr<Arrays> arrays = make_arrays();
  Arrays* a = arrays.get();
  register_widths<Copy>("simd/copy", a);
  register_widths<SquareRoot>("simd/sqrt", a);
  register_widths<Division>("simd/division", a);
  register_widths<SincosTurns>("simd/sincos_turns", a);
  register_widths<Normalize>("simd/normalize", a);
  register_widths<FrameAround>("simd/frame_around", a);
  register_widths<Pcg4d>("simd/pcg4d", a);
  register_widths<ReverseBits>("simd/reverse_bits", a);
  register_widths<FourLoads>("simd/four_values/load", a);
  register_widths<FourGathers>("simd/four_values/gather", a);
  register_widths<GatherRows>("simd/four_values/gather_rows", a);
  register_widths<AddRows>("simd/add_rows", a);
  register_widths<PackFour>("simd/pack_four", a);
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
