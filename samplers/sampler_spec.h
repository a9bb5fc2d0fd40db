// What a sampler is made of, and its one-line text form on the command line.
//
// A sampler is a sequence, a pixel's own or shared by many, x an offset that lets a pixel leave the
// shared sequence, x a weight w that says how far:
//   uc_{i,k} = (u_k + w_i * u_{i,k}) mod 1        (Staal and Hachisuka, Randomized Coherent
//   Sampling)
// The named samplers are presets; every option can be overridden.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lockstep {

// Places in the lists of sequences.h and perturbations.h.
enum class SequenceId : std::uint8_t {};
enum class PerturbationId : std::uint8_t {};  // of the offset u_{i,k}

// Whose sequence it is: every pixel has its own, those of a tile share one, or all do.
enum class Share : std::uint8_t { Pixel, Tile, Image };

// How an offset moves a shared point: Add is the formula above. Xor keeps the digits before the
// first that w reaches, the larger power of two counting, and XORs the others: nets stay nets.
enum class Mix : std::uint8_t { Add, Xor };

// w: one number; the side of the cells that the planned samples fill, 2^-m for at least 4^m; a map
// from a pilot by the poster's rule; a map from a pilot whose noise is measured.
enum class WeightSource : std::uint8_t { Constant, Cells, Map, Auto };

enum class WeightFilter : std::uint8_t { None, Gaussian, Median };  // of the pilot
enum class Combine : std::uint8_t { Add, Weight };  // by sample counts (unbiased), or by w (biased)

struct SamplerSpec {
  std::string name = "random";  // the preset's name
  Share share = Share::Pixel;
  int pairs = 0;       // of dimensions that are shared, from the first; 0: all
  int interleave = 1;  // n: n x n sequences, pixels n apart share
  SequenceId sequence{};
  PerturbationId perturbation{};
  Mix mix = Mix::Add;
  WeightSource weight_source = WeightSource::Constant;
  float weight = 1.0f;  // w for WeightSource::Constant

  // Weights from a pilot: w_i = min(1, c * d_i) where d_i >= t, else 0.
  float c = 4.0f;
  float t = 0.02f;
  WeightFilter filter = WeightFilter::Gaussian;
  int pilot = 0;  // pilot samples per pixel, part of spp; 0: a quarter of spp, at least one
  Combine combine = Combine::Add;

  bool shared() const { return share != Share::Pixel; }
  bool has_pilot() const {
    return weight_source == WeightSource::Map || weight_source == WeightSource::Auto;
  }
  // True where the expected image is the integral for any scene.
  bool unbiased() const { return !has_pilot() || combine == Combine::Add; }
};

// Parses "name" or "name:key=value,key=value". Throws UsageError naming the valid choices.
SamplerSpec parse_sampler(std::string_view text);

// The canonical text: the name and every option that differs from its preset.
std::string to_string(const SamplerSpec& spec);

// Names of all presets.
std::vector<std::string> sampler_names();

// An option as it is typed behind a preset's name, and what it takes: words with bars between, or
// what kind of number.
struct SamplerOption {
  std::string key, values;
};
std::vector<SamplerOption> sampler_options();

// Help text: each preset with its options, defaults and paper; for --help and error messages.
std::string sampler_help();

// Splits a list such as "random,rcs:c=4,t=0.02,owen" at the commas that begin a new sampler.
// (An item of the form key=value belongs to the sampler before it.)
std::vector<std::string> split_sampler_list(std::string_view list);

// By name; throw UsageError naming the valid choices.
SequenceId sequence_named(std::string_view name);
PerturbationId perturbation_named(std::string_view name);

std::string_view name(SequenceId sequence);
std::string_view name(PerturbationId perturbation);

// Whether points depend on how many samples are planned, so that a render cannot go on to more.
bool is_planned(const SamplerSpec& spec);

}  // namespace lockstep
