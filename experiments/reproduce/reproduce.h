// framesim reproduce: what the papers printed beside what the simulator gives, and the same scene under the best policy.
//
// A document is one file that defines its entry, and its two lines in registry.cpp. It reads what was printed from
// data/*.csv (published.h), runs scenes (scene_runs.h) and returns rows. No simulated figure is written down anywhere.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace framesim {

// How far a simulated figure may be from what it is held against.
struct ReproduceTarget {
  enum class Kind {
    relative,  // |simulated - published| <= value * |published|
    absolute,  // |simulated - published| <= value
    at_least,  // simulated >= value, whatever was published
    at_most,   // simulated <= value
  };
  Kind kind = Kind::relative;
  double value = 0;
};

// Where a published figure comes from (MODEL's marks).
enum class Mark {
  printed,   // [P] in the document's text
  recalled,  // [M] known from elsewhere, unconfirmed: a band, never a golden number
};

// One figure. Units: "s" (shown in ms), "fps", "%" (the value is in per cent) or "" for plain numbers.
struct ReproducedRow {
  std::string figure;    // "table 2", "section 7.2"
  std::string item;      // which row of it: "zigzag 25 ms"
  std::string quantity;  // "mean", "AvgErr"
  std::string unit;
  std::optional<double> published;  // absent: the document states it in words, or draws it
  Mark mark = Mark::printed;
  double simulated = 0;  // NaN: there was nothing to measure; such a row is outside whatever its target
  std::optional<ReproduceTarget> target;
  std::optional<double> certified;  // the same scene, machine and target under the policy `certified`
};

enum class Verdict { inside, outside, no_target };
Verdict verdict(const ReproducedRow& row);
// simulated - published over |published|, or without dividing where the target is absolute or published is 0. Absent if
// nothing was published.
std::optional<double> difference(const ReproducedRow& row);
bool is_relative(const ReproducedRow& row);

struct Reproduction {
  std::string document;  // name in the registry
  std::string title;
  std::vector<std::string> remarks;  // how it was done, one paragraph each
  std::vector<ReproducedRow> rows;
};

// What a document may use. The result depends on nothing of it but `frames`.
struct ReproduceContext {
  int jobs = 1;             // threads
  bool quiet = false;       // no progress on stderr
  std::int64_t frames = 0;  // at most so many of each camera path, for tests; 0 = all
};

struct ReproducedDocument {
  std::string_view name;   // on the command line
  std::string_view title;  // authors, title, year
  // Fills rows and remarks. Throws InputError if a scene or machine cannot be made.
  void (*reproduce)(const ReproduceContext& context, Reproduction& result);
};
std::span<const ReproducedDocument> reproduced_documents();  // registry.cpp
Reproduction reproduce(const ReproducedDocument& document, const ReproduceContext& context);

enum class ReproduceFormat { table, csv, markdown };
inline constexpr std::string_view kReproduceFormatNames[] = {"table", "csv", "markdown"};
std::string format_reproduction(std::span<const Reproduction> parts, ReproduceFormat format);

}  // namespace framesim
