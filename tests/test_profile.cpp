// Profiles: what is measured of packets, and that page and tables show it.
#include "experiments/metrics/metrics.h"
#include "experiments/profile/profile_page.h"
#include "tests/t_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lockstep::test_profile {
namespace {

// Rays from above the blocks of the Cornell box along `directions`, as one queue.
RayLog log_of(const std::vector<glm::vec3>& directions) {
  std::vector<float> x(directions.size(), 0.0f), y(directions.size(), 1.7f),
      z(directions.size(), 0.05f), dx, dy, dz;
  for (const glm::vec3& d : directions) {
    dx.push_back(d.x);
    dy.push_back(d.y);
    dz.push_back(d.z);
  }
  RayLog log;
  log.append(RayKind::Bounce, 1, int(directions.size()),
             {{x.data(), y.data(), z.data()}, {dx.data(), dy.data(), dz.data()}, nullptr});
  return log;
}

TEST(Coherence, IsOfPacketsOfSixteen) {
  const Scene scene = build(resized(read_scene("cornell"), 16, 16));
  // 24 rays: a packet of parallel ones that hit one triangle, and a half-filled one of opposite
  // ones that hit two, of two materials: the red and the green wall.
  std::vector<glm::vec3> directions(16, glm::vec3(1.0f, -0.1f, -0.2f));
  for (int i = 0; i < 8; ++i) directions.push_back({i % 2 ? 2.0f : -2.0f, 0.0f, 0.0f});
  const Coherence c = coherence_of(scene.data(), log_of(directions), {0}, 1).front();
  EXPECT_DOUBLE_EQ(c.lanes_active, 0.75);
  EXPECT_NEAR(c.spread(), 0.5, 1e-6);
  EXPECT_DOUBLE_EQ(c.triangles, 1.5);
  EXPECT_DOUBLE_EQ(c.materials, 1.5);
}

TEST(HardwareCounters, CountOrSayWhyNot) {
  HardwareCounters counters;
  counters.start();
  volatile double sum = 0.0;
  for (int i = 0; i < 1000000; ++i) sum = sum + 1.0;
  const std::optional<HardwareCounts> counts = counters.stop();
  if (!counters.unavailable().empty()) {
    EXPECT_FALSE(counts);
    EXPECT_EQ(counters.unavailable().find('\n'), std::string::npos);
  } else if (counts) {
    EXPECT_GT(counts->instructions, 1e6);
    EXPECT_GT(counts->cycles, 1e5);
  }
}

std::size_t columns(const std::string& row) {
  return std::size_t(std::count(row.begin(), row.end(), ',')) + 1;
}

// Every row has as many columns as the first.
void expect_table(const std::string& csv, std::size_t rows) {
  std::size_t found = 0, first = 0;
  for (std::size_t at = 0; at < csv.size(); ++found) {
    const std::size_t end = csv.find('\n', at);
    ASSERT_NE(end, std::string::npos);
    if (found == 0) first = columns(csv.substr(at, end - at));
    EXPECT_EQ(columns(csv.substr(at, end - at)), first) << csv.substr(at, end - at);
    at = end + 1;
  }
  EXPECT_EQ(found, rows + 1);
}

class SmallProfile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    settings = new ProfileSettings;
    settings->scene = "cornell";
    settings->sampler = parse_sampler("rcs");
    settings->weights = {{0.0f, {}}, {1.0f, {}}, {1.0f, ProfileWeight::Map{4.0f, 0.02f}}};
    settings->layouts = {parse_lane_layout("4x4x1")};
    settings->render.spp = 4;
    settings->render.depth = 2;
    settings->render.threads = 1;
    settings->repeats = 1;
    settings->seeds = 1;
    settings->reference_spp = 8;
    const Scene scene = build(resized(read_scene("cornell"), 48, 32));
    profile =
        new Profile(run_profile(scene, *settings, [](double, const std::string&) { return true; }));
  }
  static void TearDownTestSuite() {
    delete profile;
    delete settings;
  }
  static ProfileSettings* settings;
  static Profile* profile;
};
ProfileSettings* SmallProfile::settings = nullptr;
Profile* SmallProfile::profile = nullptr;

const ReplayClass& bounce_rays(const ProfilePoint& point) {
  for (const ReplayClass& c : point.replay.classes) {
    if (c.kind == RayKind::Bounce) return c;
  }
  throw std::runtime_error("no bounce rays");
}

TEST_F(SmallProfile, SharedNumbersKeepPacketsTogether) {
  ASSERT_EQ(profile->points.size(), 3u);
  const Coherence& shared = bounce_rays(profile->points[0]).coherence;
  const Coherence& independent = bounce_rays(profile->points[1]).coherence;
  EXPECT_LT(shared.spread(), 0.6 * independent.spread());
  EXPECT_LT(shared.triangles, independent.triangles);
  for (const Coherence& c : {shared, independent}) {
    EXPECT_GT(c.lanes_active, 0.0);
    EXPECT_LE(c.lanes_active, 1.0);
    EXPECT_LE(c.materials, c.triangles);
  }
}

TEST_F(SmallProfile, ErrorsAreAtEqualSamplesAndAtEqualTime) {
  ASSERT_EQ(profile->errors.size(), 3u);
  for (const WeightErrors& errors : profile->errors) {
    EXPECT_EQ(errors.equal_samples.spp, 4);
    EXPECT_GE(errors.equal_time.spp, 1);
    ASSERT_EQ(errors.equal_samples.values.size(), metrics().size());
    EXPECT_GT(errors.equal_samples.values[0], 0.0);
  }
  EXPECT_EQ(profile->errors[1].equal_time.spp, 4);  // the base itself
}

TEST_F(SmallProfile, TablesHaveARowForEach) {
  std::size_t classes = 0;
  for (const ProfilePoint& point : profile->points) classes += point.replay.classes.size();
  expect_table(profile_renders_csv(*profile, *settings), 3);
  expect_table(profile_coherence_csv(*profile, *settings), classes);
  expect_table(profile_errors_csv(*profile, *settings), 6);
  EXPECT_NE(profile_csv(*profile, *settings).find("cornell,rcs,c=4 t=0.02,4x4x1,camera,0,single,"),
            std::string::npos);
}

TEST_F(SmallProfile, PageHoldsTheData) {
  const nlohmann::ordered_json json = profile_json(*profile, *settings);
  EXPECT_EQ(json["base"]["weight"], "1");
  EXPECT_EQ(json["points"].size(), 3u);
  EXPECT_EQ(json["no_counters"].get<std::string>().empty(), profile->points[0].counts.has_value());
  const std::string html = profile_html(*profile, *settings);
  for (const char* mark : {"{{CSS}}", "{{D3}}", "{{DATA}}", "{{JS}}"}) {
    EXPECT_EQ(html.find(mark), std::string::npos) << mark;
  }
  // Nothing is loaded from elsewhere.
  for (const char* tag : {"<link", "<script src", "<img"}) {
    EXPECT_EQ(html.find(tag), std::string::npos) << tag;
  }
  const std::string start = "<script id=\"data\" type=\"application/json\">";
  const std::size_t begin = html.find(start) + start.size();
  EXPECT_EQ(
      nlohmann::ordered_json::parse(html.substr(begin, html.find("</script>", begin) - begin)),
      json);
}

}  // namespace
}  // namespace lockstep::test_profile
