#include "experiments/commands/options.h"

#include "core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace lockstep {
namespace {

constexpr int kLargestSide = 1 << 15;  // pixels

// The whole text as a number from 1 to `largest`.
std::optional<int> positive(std::string_view text, int largest) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  if (value < 1 || value > largest) return {};
  return value;
}

std::optional<double> positive_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  if (!(value > 0.0 && value < 1e12)) return {};
  return value;
}

template <class T>
std::vector<T> sorted_once(std::vector<T> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// Numbers from 1 to `largest`; `complaint` is the UsageError's text where one is none.
template <class Complaint>
std::vector<int> counts_in(std::string_view text, int largest, Complaint complaint) {
  std::vector<int> counts;
  for (const std::string& item : split_at_commas(text)) {
    const std::optional<int> count = positive(item, largest);
    if (!count) throw UsageError(complaint());
    counts.push_back(*count);
  }
  return sorted_once(std::move(counts));
}

// What shells complete an option by that takes other values too.
CLI::Validator such_as(const std::vector<std::string>& examples) {
  return CLI::Validator([](std::string&) { return std::string(); }, "")
      .name(fmt::format("{}", fmt::join(examples, "|")));
}

std::vector<std::string> traversal_names() {
  std::vector<std::string> names{"auto"};
  for (int i = 0; i < traversal_modes; ++i) {
    const TraversalMode mode = traversal_mode(i);
    if (mode != TraversalMode{Packets::Single, true}) names.push_back(to_string(mode));
  }
  return names;
}

void add_scene_options(CLI::App& command, RendererOptions& options) {
  const auto add = [&](const char* flag, auto& value, const char* type, const char* description) {
    return command.add_option(flag, value, description)->type_name(type)->group("Scene");
  };
  add("--camera", options.camera, "SPEC",
      "In place of parts of the scene's camera, any of origin=X,Y,Z:\n"
      "target=X,Y,Z:up=X,Y,Z:fov=DEGREES:lens=RADIUS:focus=DISTANCE in one\n"
      "word, or a JSON file with these keys. The fov is along the shorter\n"
      "side. 'lockstep info SCENE' shows the scene's own");
  add("--environment", options.environment, "SPEC",
      "In place of the scene's environment: a latitude-longitude image\n"
      "(.exr, .hdr), a constant radiance R,G,B, or none");
  add("--environment-up", options.environment_up, "AXIS",
      "Where the top of that image lies: x, y, z, -x, -y or -z (default: y)")
      ->check(one_of({"x", "y", "z", "-x", "-y", "-z"}));
  add("--environment-scale", options.environment_scale, "X",
      "Times the environment's radiance, the scene's own or the one given")
      ->check(number_between(0, 1e9));
  command
      .add_flag("--compensate", options.compensate,
                "Put back the light that rough metals, glass, coats and principled materials\n"
                "lose between their microfacets (Turquin 2019)")
      ->group("Scene");
  add("--intersection", options.intersection, "HOW",
      "robust: no ray slips between triangles that share an edge; fast:\n"
      "Embree's default, some may (default: robust)")
      ->check(one_of({"robust", "fast"}));
}

}  // namespace

CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        if (whole && value >= low && value <= high) return std::string();
        return fmt::format("'{}' is not a number from {} to {}", text, low, high);
      },
      "");
}

CLI::Validator whole_number_between(std::int64_t low, std::int64_t high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        if (whole && value >= low && value <= high) return std::string();
        return fmt::format("'{}' is not a whole number from {} to {}", text, low, high);
      },
      "");
}

CLI::Validator one_of(const std::vector<std::string>& choices) {
  return CLI::Validator(
             [choices](std::string& text) {
               const bool found = std::find(choices.begin(), choices.end(), text) != choices.end();
               if (found) return std::string();
               return fmt::format("'{}' is not one of {}", text, fmt::join(choices, ", "));
             },
             "")
      .name(fmt::format("{}", fmt::join(choices, "|")));
}

void refuse_empty_values(CLI::App& program) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? "the value is empty" : std::string(); }, "");
  for (CLI::App* command : program.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) option->check(not_empty);
    }
  }
}

void add_renderer_options(CLI::App& command, RendererOptions& options) {
  add_scene_options(command, options);
  const auto add = [&](const char* flag, auto& value, const char* type, const char* description) {
    return command.add_option(flag, value, description)->type_name(type)->group("Renderer");
  };
  add("--depth", options.depth, "N",
      "Surface interactions that are lit; 1 is direct light only\n(default: the scene's)")
      ->check(whole_number_between(1, 1000));
  add("--roulette-depth", options.roulette_depth, "N",
      "Interactions after which Russian roulette may end a path")
      ->check(whole_number_between(1, 1000))
      ->capture_default_str();
  add("--clamp", options.clamp, "RADIANCE",
      "Scale brighter samples down to this luminance. No fireflies, but a\n"
      "biased image that lacks their light, and is labelled so (default: off)")
      ->check(number_between(1e-6, 1e9));
  add("--resolution", options.resolution, "WxH", "Image size in pixels (default: the scene's)");
  add("--threads", options.threads, "N", "Threads; 0 means one for each processor")
      ->check(whole_number_between(0, 4096))
      ->capture_default_str();
  add("--width", options.width, "LANES",
      "SIMD lanes: 1, 4, 8, 16, or auto: the fastest for the instruction set")
      ->check(one_of({"auto", "1", "4", "8", "16"}))
      ->capture_default_str();
  add("--lanes", options.lanes, "XxYxS",
      "Rays that share packets: pixels across x pixels down x samples of\n"
      "each, such as 4x4x1, 2x2x4 or 1x1x16, or auto: measured while\n"
      "rendering. The image is the same")
      ->capture_default_str();
  add("--traversal", options.traversal, "MODE",
      "How rays go through Embree: single, packet4, packet8, packet16,\n"
      "stream1m or streamnm (Embree 3 only), with -coherent behind it for\n"
      "Embree's coherent flag, or auto: measured while rendering, by kind\n"
      "of ray and bounce. The image is the same")
      ->check(such_as(traversal_names()))
      ->capture_default_str();
  command
      .add_flag("--general", options.general,
                "Use the kernels for all scenes, not those without the code that this\n"
                "scene does not need. The image is the same")
      ->group("Renderer");
  add("--isa", options.isa, "ISA",
      "Instruction set of the kernels: sse4, avx2, avx512, neon (ARM64), or\n"
      "auto: the widest this CPU has, unless LOCKSTEP_ISA is set")
      ->check(one_of({"auto", "sse4", "avx2", "avx512", "neon"}))
      ->capture_default_str();
}

void add_rank_options(CLI::App& command, double& timeout) {
  command
      .add_option("--rank-timeout", timeout,
                  "Under mpirun or srun: what a rank has to do goes to others once it\n"
                  "has sent nothing for so long")
      ->type_name("SECONDS")
      ->check(number_between(0.1, 1e9))
      ->capture_default_str()
      ->group("Several machines");
}

RenderSettings render_settings(const RendererOptions& options) {
  RenderSettings settings;
  settings.isa = choose_isa(options.isa);
  settings.roulette_depth = options.roulette_depth;
  settings.clamp = options.clamp;
  settings.threads = options.threads;
  settings.width = options.width == "auto" ? 0 : std::stoi(options.width);
  settings.traversal = parse_traversal(options.traversal);
  settings.specialized = !options.general;
  if (options.lanes != "auto") settings.lanes = parse_lane_layout(options.lanes);
  return settings;
}

SceneOverrides scene_overrides(const RendererOptions& options) {
  SceneOverrides overrides;
  if (!options.camera.empty()) overrides.camera = parse_camera(options.camera);
  overrides.environment =
      parse_environment(options.environment, options.environment_scale, options.environment_up);
  overrides.compensate = options.compensate;
  overrides.robust_intersection = options.intersection == "robust";
  return overrides;
}

SceneDescription read_described(const std::string& scene, const RendererOptions& options,
                                const SceneOverrides& overrides, bool quiet) {
  SceneDescription description = read_scene(scene, overrides);
  for (const std::string& warning : description.warnings) {
    if (!quiet) fmt::print(stderr, "lockstep: warning: {}\n", warning);
  }
  if (!options.resolution.empty()) {
    const glm::ivec2 size = parse_resolution(options.resolution);
    description.film.width = size.x;
    description.film.height = size.y;
  }
  return description;
}

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    items.emplace_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return items;
}

std::vector<float> parse_weights(std::string_view text) {
  std::vector<float> weights;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    float value = -1.0f;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error != std::errc() || end != item.data() + item.size() ||
        !(value >= 0.0f && value <= 1.0f)) {
      throw UsageError(fmt::format(
          "--weights: '{}' is not a list of numbers from 0 to 1, such as 0,0.125,1", text));
    }
    weights.push_back(value);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::sort(weights.begin(), weights.end());
  weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
  return weights;
}

glm::ivec2 parse_resolution(std::string_view text) {
  const std::size_t x = text.find('x');
  if (x != std::string_view::npos) {
    const std::optional<int> width = positive(text.substr(0, x), kLargestSide);
    const std::optional<int> height = positive(text.substr(x + 1), kLargestSide);
    if (width && height) return {*width, *height};
  }
  throw UsageError(
      fmt::format("--resolution: '{}' is not WxH with sides from 1 to {} pixels, such as 512x512",
                  text, kLargestSide));
}

std::vector<int> parse_sample_counts(std::string_view text) {
  return counts_in(text, 1 << 24, [text] {
    return fmt::format(
        "--spp: '{}' is not a list of samples per pixel from 1 to 16777216, such as 4,16,64", text);
  });
}

std::vector<int> parse_depths(std::string_view text) {
  return counts_in(text, 1000, [text] {
    return fmt::format("--depth: '{}' is not a list of depths from 1 to 1000, such as 1,5", text);
  });
}

std::vector<double> parse_time_budgets(std::string_view text) {
  std::vector<double> budgets;
  for (const std::string& item : split_at_commas(text)) {
    const std::optional<double> seconds = positive_number(item);
    if (!seconds) {
      throw UsageError(fmt::format(
          "--time-budgets: '{}' is not a list of seconds of CPU time above 0, such as 1,2,4",
          text));
    }
    budgets.push_back(*seconds);
  }
  return sorted_once(std::move(budgets));
}

std::vector<std::pair<std::string, double>> parse_targets(std::string_view text) {
  std::vector<std::pair<std::string, double>> targets;
  for (const std::string& item : split_at_commas(text)) {
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::optional<double> error =
        positive_number(std::string_view(item).substr(std::min(equals + 1, item.size())));
    if (!error) {
      throw UsageError(fmt::format(
          "--targets: '{}' is not METRIC=ERROR with an error above 0, such as flip_ldr=0.05",
          item));
    }
    targets.emplace_back(item.substr(0, equals), *error);
  }
  return targets;
}

}  // namespace lockstep
