// What a sampler is made of, and its one-line text form on the command line.
//
// A sampler is a sequence, shared by all pixels or a pixel's own, x a perturbation that lets a
// pixel leave the shared sequence, x a weight w that says how far:
//   uc_{i,k} = (u_k + w_i * u_{i,k}) mod 1        (Staal and Hachisuka, Randomized Coherent
//   Sampling)
// The names `random`, `owen`, `cpt` and `rcs` are presets; every option can be overridden.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

enum class Sequence { Random, Owen };  // u_k: independent, or Owen-scrambled Sobol
enum class Perturbation {
  None,
  Fresh,
  Constant
};                                          // u_{i,k}: none, new for each k, fixed per pixel
enum class WeightSource { Constant, Map };  // w_i: one number, or a map made from a pilot
enum class WeightFilter { None, Gaussian, Median };  // applied to the pilot before differences
enum class Combine { Add, Weight };  // by sample counts (unbiased), or by w (biased)

struct SamplerSpec {
  std::string name = "random";  // the preset's name
  bool shared = false;          // one sequence for all pixels, or one for each
  Sequence sequence = Sequence::Random;
  Perturbation perturbation = Perturbation::None;
  WeightSource weight_source = WeightSource::Constant;
  float weight = 1.0f;  // w for WeightSource::Constant

  // Weights from a pilot: w_i = min(1, c * d_i) where d_i >= t, else 0.
  float c = 4.0f;
  float t = 0.02f;
  WeightFilter filter = WeightFilter::Gaussian;
  int pilot = 0;  // pilot samples per pixel, part of spp; 0: a quarter of spp, at least one
  Combine combine = Combine::Add;

  // True where the expected image is the integral for any scene; see docs of Combine::Weight.
  bool unbiased() const {
    return weight_source == WeightSource::Constant || combine == Combine::Add;
  }
};

// Parses "name" or "name:key=value,key=value". Throws UsageError naming the valid choices.
SamplerSpec parse_sampler(std::string_view text);

// The canonical text: the name and every option that differs from its preset.
std::string to_string(const SamplerSpec& spec);

// Help text: each preset with its options, defaults and paper; for --help and error messages.
std::string sampler_help();

// Splits a list such as "random,rcs:c=4,t=0.02,owen" at the commas that begin a new sampler.
// (An item of the form key=value belongs to the sampler before it.)
std::vector<std::string> split_sampler_list(std::string_view list);

}  // namespace lockstep
