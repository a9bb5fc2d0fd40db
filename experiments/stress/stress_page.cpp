// stress.html: what was tested, what came out, and pictures, in one file.
#include "core/image_module.h"
#include "experiments/output/machine.h"
#include "experiments/output/preview.h"
#include "experiments/stress/stress.h"

#include <fmt/format.h>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>
#include <iterator>

namespace lockstep {
namespace {

constexpr int kLargestPicture = 64;  // pixels along a side; larger images are thinned out

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:78em;padding:0 1em;"
    "color:#222;background:#fff}"
    "table{border-collapse:collapse;width:100%}"
    "th,td{text-align:left;vertical-align:top;padding:.35em .6em;border-bottom:1px solid #ddd}"
    "td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}"
    "img{width:56px;height:56px;image-rendering:pixelated;margin-right:3px;border:1px solid #ccc}"
    "details table{font-size:.85em}summary{cursor:pointer;color:#456}"
    ".v{border-radius:.6em;padding:.1em .6em;white-space:nowrap}"
    ".right{background:#d9f0dd}.unsupported{background:#fbeccb}.vague{background:#e6e2f5}"
    ".wrong{background:#f7d0d0}small{color:#567}";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  }
  return out;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<const unsigned char*, 6, 8>>;
  std::string text(Digits(bytes.data()), Digits(bytes.data() + bytes.size()));
  return text.append((3 - bytes.size() % 3) % 3, '=');
}

Image thinned_out(const Image& image) {
  const int step_x = (image.width + kLargestPicture - 1) / kLargestPicture;
  const int step_y = (image.height + kLargestPicture - 1) / kLargestPicture;
  Image small(image.width / step_x, image.height / step_y);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::copy_n(image.at(x * step_x, y * step_y), 3, small.at(x, y));
    }
  }
  return small;
}

// One exposure for all samplers' pictures of a case.
std::string picture_elements(const StressResult& result) {
  std::string html;
  for (const StressPicture& p : result.pictures) {
    const Image shown = exposed(thinned_out(p.image), preview_exposure(result.pictures[0].image));
    const auto png = encode_with_module("picture.png", shown, {}, Depth::Byte);
    html += fmt::format("<img alt=\"{0}\" title=\"{0}\" src=\"data:image/png;base64,{1}\">",
                        escaped(p.sampler), base64(png));
  }
  return html;
}

std::string badge(StressVerdict v) {
  return fmt::format("<span class=\"v {0}\">{0}</span>", name(v));
}

std::string nonfinite_text(const StressRow& row) {
  std::string text = fmt::format("{}", row.nonfinite);
  for (const StressBadSample& b : row.bad) {
    text += fmt::format("<br>({}, {}) sample {} seed {}", b.at.x, b.at.y, b.at.sample, b.seed);
  }
  return text;
}

std::string rows_table(const StressResult& result) {
  std::string html =
      "<table><tr><th>width<th>sampler<th class=n>got<th class=n>standard error"
      "<th class=n>tolerance<th>verdict<th class=n>not finite<th class=n>fireflies<th class=n>s"
      "<th>message</tr>";
  for (const StressRow& r : result.rows) {
    html += fmt::format(
        "<tr><td>{}<td>{}<td class=n>{:.8g}<td class=n>{}<td class=n>{}<td>{}"
        "<td class=n>{}<td class=n>{}<td class=n>{:.3f}<td>{}</tr>",
        r.width > 0 ? std::to_string(r.width) : "any", r.sampler.empty() ? "any" : r.sampler, r.got,
        r.judged ? fmt::format("{:.2g}", r.standard_error) : "same bits",
        r.judged ? fmt::format("{:.2g}", r.tolerance) : "", badge(r.verdict), nonfinite_text(r),
        r.fireflies, r.seconds, escaped(r.message));
  }
  return html + "</table>";
}

std::string case_rows(const StressResult& result) {
  const StressRow& worst = worst_row(result);
  std::uint64_t nonfinite = 0;
  for (const StressRow& r : result.rows) nonfinite += r.nonfinite;
  const std::string message =
      worst.message.empty() ? "" : "<br><small>" + escaped(worst.message) + "</small>";
  return fmt::format(
      "<tr><td><b>{}</b><br>{}<br><small>{}</small><details><summary>{} rows</summary>{}</details>"
      "<td>{}<td class=n>{:.6g}<td class=n>{:.6g}<td class=n>{:.2g}<td>{}{}<td class=n>{}"
      "<td class=n>{:.1f}</tr>\n",
      escaped(result.tested.name), escaped(result.tested.extreme), escaped(result.tested.argument),
      result.rows.size(), rows_table(result), picture_elements(result), worst.expected, worst.got,
      worst.standard_error, badge(verdict(result)), message, nonfinite, result.seconds);
}

std::string introduction(const std::vector<StressResult>& results, const StressPlan& plan) {
  int counts[4] = {};
  for (const StressResult& result : results) ++counts[int(verdict(result))];
  return fmt::format(
      "<h1>Stress battery</h1><p>{} cases: {} right, {} unsupported, {} vague, {} wrong. "
      "Widths {}, samplers {}, {} seeds{}; the chance that correct code fails any test is {}. "
      "Lockstep {}, {}, {}.</p><p>A mean over seeds is right where Student's t explains its "
      "difference from the expected value, or rounding does. Every width must give the first "
      "one's bits. The row shown is the worst; pictures are the first seed's, one for each "
      "sampler.</p>",
      results.size(), counts[0], counts[1], counts[2], counts[3], fmt::join(plan.widths, ", "),
      fmt::join(plan.samplers, ", "), plan.seeds, plan.quick ? ", quick" : "", plan.level,
      version(), escaped(cpu_name()), date_and_time());
}

}  // namespace

std::string stress_page(const std::vector<StressResult>& results, const StressPlan& plan) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Stress battery"
      "</title><style>{}</style></head><body>{}",
      kStyle, introduction(results, plan));
  std::string family;
  for (const StressResult& result : results) {
    if (result.tested.family != family) {
      if (!family.empty()) html += "</table>";
      family = result.tested.family;
      html += fmt::format(
          "<h2>{}</h2><table><tr><th>case<th>pictures<th class=n>expected<th class=n>got"
          "<th class=n>standard error<th>verdict<th class=n>not finite<th class=n>s</tr>\n",
          escaped(family));
    }
    html += case_rows(result);
  }
  if (!family.empty()) html += "</table>";
  return html + "</body></html>\n";
}

}  // namespace lockstep
