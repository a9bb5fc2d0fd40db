#include "packets/shared_render.h"

#include "core/cpu_clock.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/memory.h"
#include "packets/checkpoint.h"
#include "packets/pass.h"
#include "samplers/dimensions.h"
#include "samplers/make_state.h"
#include "samplers/weight_map.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

namespace lockstep {
namespace {

constexpr std::uint32_t longest_pass = film_block;  // samples
constexpr std::uint32_t longest_shared_pass = 64 * film_block;
constexpr std::uint32_t most_samples = 1u << 24;  // that a render for a time takes

// How many samples go to the pilot. A render for a time does not know its spp: it takes 4.
int pilot_samples(const SamplerSpec& sampler, const RenderSettings& settings) {
  if (!sampler.has_pilot()) return 0;
  if (settings.time_seconds > 0.0) return sampler.pilot > 0 ? sampler.pilot : 4;
  const int wanted = sampler.pilot > 0 ? sampler.pilot : std::max(1, settings.spp / 4);
  return std::min(wanted, settings.spp);
}

// Independent keys for what must be independent: C's samples must not know R's.
std::uint32_t stream_seed(std::uint32_t seed, std::uint32_t stream) {
  return pcg3d(seed, stream, 0x1ec5u).x;
}

// The pilot: every pixel has its own sequence, of the kind that the image's pixels share.
SamplerSpec pilot_sampler(const SamplerSpec& sampler) {
  SamplerSpec pilot;
  pilot.sequence = sampler.sequence;
  return pilot;
}

RayCounts ray_counts(const TileCounts& counts) {
  std::uint64_t of[ray_kinds] = {};
  for (int kind = 0; kind < ray_kinds; ++kind) {
    for (const std::uint64_t n : counts.traced[kind]) of[kind] += n;
  }
  return {of[int(RayKind::Camera)], of[int(RayKind::Bounce)], of[int(RayKind::Shadow)]};
}

LaneLayout layout_of_most_paths(const TileCounts& counts) {
  const auto* most =
      std::max_element(std::begin(counts.layouts), std::end(counts.layouts),
                       [](const auto& a, const auto& b) { return a.paths < b.paths; });
  return most->lanes;
}

// Before any of it is taken, with sums of earlier blocks where there will be some: sums of the
// image, of the pilot and of its half, and the image itself.
void require_film_memory(const FilmDescription& film, const SamplerSpec& sampler,
                         const RenderSettings& settings) {
  const int films = sampler.has_pilot() ? sampler.weight_source == WeightSource::Auto ? 3 : 2 : 1;
  const bool has_blocks = settings.time_seconds > 0.0 || std::uint32_t(settings.spp) > film_block;
  const double bytes = films * (has_blocks ? 8.0 : 4.0) * sizeof(double) + 3.0 * sizeof(float);
  require_memory(double(film.width) * film.height * bytes,
                 fmt::format("an image of {}x{} pixels", film.width, film.height),
                 "choose a smaller --resolution");
}

// Others help for as long as this lives.
class SharedScope {
 public:
  SharedScope(const TileSharing& sharing, const SharedPass& pass, TilePool& pool)
      : sharing_(sharing) {
    sharing.begin(pass, pool);
  }
  ~SharedScope() { sharing_.end(); }
  SharedScope(const SharedScope&) = delete;
  SharedScope& operator=(const SharedScope&) = delete;

 private:
  const TileSharing& sharing_;
};

class Renderer {
 public:
  Renderer(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
           const Progress& progress, const TileSharing* sharing)
      : scene_(scene),
        sampler_(sampler),
        settings_(settings),
        progress_(progress),
        sharing_(sharing),
        start_(wall_seconds()),
        counted_(start_),
        workers_(TraversalPolicy(settings.traversal, default_width(settings.isa)),
                 LayoutPolicy(settings.lanes)) {
    const FilmDescription& film = scene.description().film;
    pass_.kernel = &find_kernel(settings.isa, settings.width,
                                settings.specialized ? scene.features() : all_features);
    pass_.workers = &workers_;
    pass_.log = settings.log;
    pass_.scene = &scene.data();
    pass_.path.depth = settings.depth, pass_.path.roulette_depth = settings.roulette_depth;
    if (settings.clamp) pass_.path.clamp = *settings.clamp;
    pass_.order = settings.tile_order;
    title_ = fmt::format("scene {}, sampler {}, seed {}",
                         settings.scene_name.empty() ? "without a name" : settings.scene_name,
                         to_string(sampler), settings.seed);
    pass_.site.render = title_.c_str();
    pass_.site.command = settings.command.c_str();
    pass_.threads = settings.threads > 0 ? settings.threads
                                         : int(std::max(1u, std::thread::hardware_concurrency()));
    pilot_spp_ = pilot_samples(sampler, settings);
    state_.image = Film(film.width, film.height);
    if (pilot_spp_ > 0) state_.pilot = Film(film.width, film.height);
    if (sampler.weight_source == WeightSource::Auto) state_.half_pilot = state_.pilot;
  }

  RenderResult run() {
    // More threads than cores are given if asked for.
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      std::size_t(pass_.threads));
    restore();
    RenderResult result;
    SamplerState state = make_state(sampler_, stream_seed(settings_.seed, 0),
                                    plan(std::uint32_t(settings_.spp - pilot_spp_)));
    double weight = sampler_.shared() && image_follows() ? double(state.weight) : 1.0;
    double zero_weights = weight == 0.0 ? 1.0 : 0.0;
    if (pilot_spp_ > 0) {
      render_pilot();
    }
    if (pilot_spp_ > 0 && image_follows()) {
      const double before = thread_cpu_seconds();
      result.weights = weights();
      weight = mean_weight(*result.weights);
      zero_weights = share_of_zeros(*result.weights);
      weights_seconds_ = thread_cpu_seconds() - before;
      state_.totals.cpu_seconds += weights_seconds_;
      state.weights = result.weights->pixels.data();
    }
    pass_.sampler = &state;
    if (settings_.time_seconds > 0.0) {
      render_for_time();
    } else {
      render_to(state_.image, std::uint32_t(settings_.spp - pilot_spp_));
    }
    result.image = combine(result.weights);
    result.stats = stats(weight, zero_weights);
    return result;
  }

  // Another process leads: what help() renders belongs to this pass.
  void help_with(SharedPass shared) {
    shared_ = std::move(shared);
    shared_state_ = shared_.is_pilot ? pilot_state()
                                     : make_state(sampler_, stream_seed(settings_.seed, 0),
                                                  plan(std::uint32_t(settings_.spp - pilot_spp_)));
    if (!shared_.weights.empty()) shared_state_->weights = shared_.weights.data();
    pass_.sampler = &*shared_state_;
  }

  // Sums of the work, by tiles, from `start` or from 0 where that is empty.
  std::vector<double> help(const TileWork& work, const std::vector<double>& start,
                           PassTotals& totals) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      std::size_t(pass_.threads));
    set_sums(state_.image, work, start);
    const bool finished = run_tiles(pass_, state_.image, work, totals,
                                    [&](double share) { return !progress_ || progress_(share); });
    if (!finished) throw Cancelled();
    return sums_of(state_.image, work);
  }

 private:
  // False where all samples go to the pilot, which then is the image: nothing needs weights.
  bool image_follows() const { return settings_.time_seconds > 0.0 || settings_.spp > pilot_spp_; }

  std::uint32_t samples_done() const { return state_.pilot.samples + state_.image.samples; }

  // A render for a time does not know its samples: it plans for 16, and again for as many.
  SamplePlan plan(std::uint32_t samples) const {
    const FilmDescription& film = scene_.description().film;
    const std::uint32_t planned = settings_.time_seconds > 0.0 ? SamplePlan().samples : samples;
    return {film.width, film.height, planned};
  }

  SamplerState pilot_state() const {
    return make_state(pilot_sampler(sampler_), stream_seed(settings_.seed, 1),
                      plan(std::uint32_t(pilot_spp_)));
  }

  void render_pilot() {
    const SamplerState state = pilot_state();
    pass_.sampler = &state;
    if (sampler_.weight_source == WeightSource::Auto && state_.half_pilot.samples == 0) {
      render_to(state_.pilot, std::uint32_t(pilot_spp_ / 2));
      state_.half_pilot = state_.pilot;
    }
    render_to(state_.pilot, std::uint32_t(pilot_spp_));
  }

  Image weights() const {
    const Image pilot = mean(state_.pilot);
    if (sampler_.weight_source == WeightSource::Map) {
      return make_weights(pilot, {sampler_.c, sampler_.t, sampler_.filter});
    }
    // A render for a time does not know: as if the image got as many samples as the pilot.
    const int samples = settings_.time_seconds > 0.0 ? pilot_spp_ : settings_.spp - pilot_spp_;
    const Image variance = state_.half_pilot.samples > 0
                               ? variance_of_mean(state_.pilot, state_.half_pilot)
                               : variance_of_neighbours(pilot);
    return make_auto_weights(pilot, variance, double(pilot_spp_) / std::max(samples, 1));
  }

  // Passes of at most 64 samples, after which the film is whole again: shorter ones where it is
  // saved, doubling up to some seconds each. A pass that is cut short is lost, those before it not.
  void render_to(Film& film, std::uint32_t samples) {
    const std::uint32_t longest = sharing_ ? longest_shared_pass : longest_pass;
    std::uint32_t chunk = settings_.resume_file.empty() ? longest : 1;
    while (film.samples < samples) {
      const double before = wall_seconds();
      run_samples(film, std::min(chunk, samples - film.samples));
      if (wall_seconds() - before < 5.0) chunk = std::min(2 * chunk, longest);
    }
  }

  // Passes until the time is used up: each as long as fits by the speed so far, so that the last
  // ones are single samples.
  void render_for_time() {
    std::uint32_t chunk = 1;
    while (state_.image.samples < most_samples) {
      const double before = wall_seconds();
      run_samples(state_.image, chunk);
      const double now = wall_seconds();
      const double per_sample = (now - before) / pass_.samples;
      const double left = settings_.time_seconds - (now - start_);
      if (left < per_sample) break;
      const double longest = std::min<double>(2 * chunk, longest_pass);
      chunk = std::uint32_t(std::clamp(0.5 * left / per_sample, 1.0, longest));
    }
  }

  void run_samples(Film& film, std::uint32_t samples) {
    pass_.samples = whole_blocks(film.samples, samples);
    if (settings_.watch) {
      pass_.watch = [watch = watch_of(film)](const TileJob& tile) {
        watch({tile.x0, tile.y0, tile.x1, tile.y1});
      };
    }
    const double done = double(samples_done());
    const std::function<bool(double)> show = [&](double share) {
      if (!progress_) return true;
      const double fraction = settings_.time_seconds > 0.0
                                  ? (wall_seconds() - start_) / settings_.time_seconds
                                  : (done + share * pass_.samples) / double(settings_.spp);
      return progress_(std::min(fraction, 1.0));
    };
    const bool finished =
        sharing_ ? run_shared(film, show) : run_pass(pass_, film, state_.totals, show);
    if (!finished) throw Cancelled();
    save();
  }

  // As run_pass(), with the help of others. This process takes its parts like them.
  bool run_shared(Film& film, const std::function<bool(double)>& show) {
    TilePool pool(film, pass_.samples, sharing_->parties, watch_of(film));
    SharedPass shared{&film == &state_.pilot, {}};
    if (pass_.sampler->weights) {
      const float* weights = pass_.sampler->weights;
      shared.weights.assign(weights, weights + film.sums.size() / 4);
    }
    if (!own_tiles_) own_tiles_.emplace(film.width, film.height);
    Pass own = pass_;
    own.watch = {};
    const SharedScope scope(*sharing_, shared, pool);
    bool goes_on = true;
    while (goes_on && !pool.done()) {
      if (const std::optional<TileWork> work = pool.take(pass_.threads)) {
        PassTotals totals;
        set_sums(*own_tiles_, *work, pool.start(*work));
        goes_on = run_tiles(own, *own_tiles_, *work, totals,
                            [&](double) { return show(pool.share_done()); });
        if (goes_on) pool.deliver(*work, sums_of(*own_tiles_, *work), totals);
      } else {
        pool.wait(0.05);
        goes_on = show(pool.share_done());
      }
    }
    if (!goes_on) return false;
    add(state_.totals, pool.totals());
    film.samples += pass_.samples;
    return true;
  }

  std::function<void(const TileArea&)> watch_of(const Film& film) const {
    if (!settings_.watch) return {};
    return [&](const TileArea& area) {
      settings_.watch(area.x0, area.y0, mean(film, area.x0, area.y0, area.x1, area.y1));
    };
  }

  // Everything that a sample's value depends on.
  std::string key() const {
    const FilmDescription& film = scene_.description().film;
    return fmt::format("scene {:016x} {} {}x{} seed {} depth {} roulette {} pilot {} isa {}",
                       scene_.fingerprint(), to_string(sampler_), film.width, film.height,
                       settings_.seed, settings_.depth, settings_.roulette_depth, pilot_spp_,
                       name(settings_.isa)) +
           (settings_.clamp ? fmt::format(" clamp {}", *settings_.clamp) : "") +
           (is_planned(sampler_) ? fmt::format(" samples {}", settings_.spp) : "");
  }
  void restore() {
    if (!settings_.resume_file.empty()) load_checkpoint(settings_.resume_file, key(), state_);
  }
  void save() {
    if (settings_.resume_file.empty()) return;
    const double now = wall_seconds();
    state_.wall_seconds += now - counted_;
    counted_ = now;
    save_checkpoint(settings_.resume_file, key(), state_);
  }

  Image combine(const std::optional<Image>& weights) const {
    if (weights && sampler_.combine == Combine::Weight && state_.image.samples > 0) {
      return interpolate(state_.pilot, state_.image, *weights);
    }
    return pilot_spp_ > 0 ? mean(state_.pilot, state_.image) : mean(state_.image);
  }

  // Ticks run on while a thread waits for its turn; CPU time is shared out in their proportion.
  double stage_seconds(int stage) const {
    std::uint64_t all = 0;
    for (const std::uint64_t ticks : state_.totals.counts.ticks.of) all += ticks;
    const double share = all > 0 ? double(state_.totals.counts.ticks.of[stage]) / double(all) : 0.0;
    return share * (state_.totals.cpu_seconds - weights_seconds_);
  }

  RenderStats stats(double weight, double zero_weights) const {
    const TileCounts& counts = state_.totals.counts;
    RenderStats s;
    s.wall_seconds = state_.wall_seconds + wall_seconds() - counted_;
    s.cpu_seconds = state_.totals.cpu_seconds;
    s.rays = ray_counts(counts);
    s.paths = s.rays.camera;
    for (int stage = 0; stage < stages; ++stage) s.stage_seconds[stage] = stage_seconds(stage);
    std::memcpy(s.traced, counts.traced, sizeof s.traced);
    s.packets = counts.packets;
    s.width = pass_.kernel->width;
    for (const Film* film : {&state_.image, &state_.pilot}) {
      s.film_bytes += (film->sums.size() + film->earlier.size()) * sizeof(double);
    }
    s.film_bytes += state_.image.sums.size() / 4 * 3 * sizeof(float);
    if (counts.lanes > 0) s.lanes_active = double(counts.active_lanes) / double(counts.lanes);
    s.clamped = counts.clamped;
    s.nonfinite = counts.nonfinite;
    s.bad_samples.assign(counts.bad,
                         counts.bad + std::min<std::uint64_t>(counts.nonfinite, TileCounts::kept));
    s.spp = int(samples_done());
    s.pilot_spp = pilot_spp_;
    s.mean_weight = weight;
    s.zero_weights = zero_weights;
    s.lanes = layout_of_most_paths(counts);
    s.threads = pass_.threads;
    return s;
  }

  const Scene& scene_;
  const SamplerSpec& sampler_;
  const RenderSettings& settings_;
  const Progress& progress_;
  const TileSharing* sharing_;  // null: this process alone
  std::string title_;
  double start_;    // of this run, wall clock
  double counted_;  // up to when state_.wall_seconds counts
  double weights_seconds_ = 0.0;
  RenderState state_;
  Workers workers_;
  Pass pass_;
  int pilot_spp_ = 0;
  std::optional<Film> own_tiles_;  // of what this process renders of a shared pass
  // Of a process that helps.
  std::optional<SamplerState> shared_state_;
  SharedPass shared_;
};

void check(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings) {
  if (settings.spp < 1 && settings.time_seconds <= 0.0) throw UsageError("spp must be at least 1");
  if (settings.depth < 1 || settings.depth > max_depth) {
    throw UsageError(fmt::format("depth must lie in 1..{}", max_depth));
  }
  if (settings.clamp && !(*settings.clamp > 0.0f)) {
    throw UsageError("the clamp must be a luminance above 0");
  }
  if (settings.log && settings.threads != 1) {
    throw UsageError("rays can be kept with one thread only");
  }
  require_film_memory(scene.description().film, sampler, settings);
}

}  // namespace

RenderResult render(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                    const Progress& progress) {
  check(scene, sampler, settings);
  return Renderer(scene, sampler, settings, progress, nullptr).run();
}

RenderResult render(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                    const Progress& progress, const TileSharing& sharing) {
  check(scene, sampler, settings);
  return Renderer(scene, sampler, settings, progress, &sharing).run();
}

class TileRenderer::Implementation {
 public:
  Implementation(const Scene& scene, const SamplerSpec& sampler, const RenderSettings& settings,
                 Progress alive)
      : sampler_(sampler),
        settings_(settings),
        alive_(std::move(alive)),
        renderer_(scene, sampler_, settings_, alive_, nullptr) {}

  Renderer& renderer() { return renderer_; }

 private:
  const SamplerSpec sampler_;
  const RenderSettings settings_;
  const Progress alive_;
  Renderer renderer_;
};

TileRenderer::TileRenderer(const Scene& scene, const SamplerSpec& sampler,
                           const RenderSettings& settings, Progress alive) {
  check(scene, sampler, settings);
  implementation_ = std::make_unique<Implementation>(scene, sampler, settings, std::move(alive));
}

TileRenderer::~TileRenderer() = default;

void TileRenderer::begin(SharedPass pass) {
  implementation_->renderer().help_with(std::move(pass));
}

std::vector<double> TileRenderer::render(const TileWork& work, const std::vector<double>& start,
                                         PassTotals& totals) {
  return implementation_->renderer().help(work, start, totals);
}

}  // namespace lockstep
