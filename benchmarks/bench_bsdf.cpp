// Reflection models: time per lane of eval and of sample, by width. As in shading, the parameters
// come from the table of materials, where every lane may have another row; that is included.
#include "bench_lanes.h"
#include "bench_main.h"
#include "core/bsdf.h"

#include <memory>

namespace lockstep {
namespace {

constexpr int materials = 16;

struct alignas(64) Arrays {
  FloatLanes wo[3], wi[3];
  FloatLanes lobe, u, v;
  IntLanes material;
  float parameters[materials * material_stride + 3];  // see core/scene_data.h
  FloatLanes direction[3], value[3], pdf;
};

template <int W>
LOCKSTEP_INLINE Vec3<Float<W>> vector_at(const FloatLanes* a, int i) {
  using V = Float<W>;
  return {load<V>(a[0] + i), load<V>(a[1] + i), load<V>(a[2] + i)};
}

template <class V>
LOCKSTEP_INLINE void write(FloatLanes* a, int i, const Vec3<V>& v) {
  store(a[0] + i, v.x);
  store(a[1] + i, v.y);
  store(a[2] + i, v.z);
}

void fill_parameters(Arrays& a, MaterialKind kind) {
  for (int m = 0; m < materials; ++m) {
    float* row = a.parameters + m * material_stride;
    for (int j = 0; j < material_stride; ++j) row[j] = 0.1f + 0.8f * uniform(m, 16u + unsigned(j));
    if (kind == MaterialKind::Coated) {
      row[7] = 1.5f;
      row[8] = 1.0f;
      row[9] = 0.6f;
    }
  }
}

std::unique_ptr<Arrays> make_arrays(MaterialKind kind) {
  auto a = std::make_unique<Arrays>();
  fill_parameters(*a, kind);
  for (int i = 0; i < lane_count; ++i) {
    write<float>(a->wo, i, cosine_hemisphere(Vec2<float>(uniform(i, 0), uniform(i, 1))));
    write<float>(a->wi, i, cosine_hemisphere(Vec2<float>(uniform(i, 2), uniform(i, 3))));
    a->lobe[i] = uniform(i, 4);
    a->u[i] = uniform(i, 5);
    a->v[i] = uniform(i, 6);
    a->material[i] = std::int32_t(uniform(i, 7) * materials);
  }
  return a;
}

template <MaterialKind K, int W>
LOCKSTEP_INLINE auto bsdf_at(const Arrays& a, int i) {
  const MaterialTable table{a.parameters};
  const Int<W> material = load<Int<W>>(a.material + i);
  if constexpr (K == MaterialKind::Diffuse) return load_diffuse(table, material);
  if constexpr (K == MaterialKind::Conductor) return load_conductor(table, material);
  if constexpr (K == MaterialKind::Coated) return load_coated(table, material);
}

template <MaterialKind K>
struct Eval {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    const auto r = eval(bsdf_at<K, W>(a, i), vector_at<W>(a.wo, i), vector_at<W>(a.wi, i));
    write(a.value, i, r.f_cos);
    store(a.pdf + i, r.pdf);
  }
};

template <MaterialKind K>
struct Sample {
  template <int W>
  LOCKSTEP_INLINE void run(Arrays& a, int i) {
    using V = Float<W>;
    const auto r = sample(bsdf_at<K, W>(a, i), vector_at<W>(a.wo, i), load<V>(a.lobe + i),
                          Vec2<V>(load<V>(a.u + i), load<V>(a.v + i)));
    write(a.direction, i, r.wi);
    write(a.value, i, r.weight);
    store(a.pdf + i, r.pdf);
  }
};

template <MaterialKind K>
void register_model(const std::string& name) {
  static const std::unique_ptr<Arrays> arrays = make_arrays(K);
  register_widths<Eval<K>>("bsdf/" + name + "/eval", arrays.get());
  register_widths<Sample<K>>("bsdf/" + name + "/sample", arrays.get());
}

void register_all() {
  register_model<MaterialKind::Diffuse>("diffuse");
  register_model<MaterialKind::Conductor>("conductor");
  register_model<MaterialKind::Coated>("coated");
}

}  // namespace
}  // namespace lockstep

int main(int argc, char** argv) {
  return lockstep::run_benchmarks(argc, argv, lockstep::register_all);
}
