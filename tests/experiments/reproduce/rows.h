// A document's rows, as tests look at them.
#pragma once

#include <cmath>
#include <string>

#include "experiments/reproduce/reproduce.h"
#include "tests/catch.h"

namespace framesim {

// Fewer frames where every one takes ten times as long.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSlowBuild = true;
#else
inline constexpr bool kSlowBuild = false;
#endif

inline Reproduction reproduce_by_name(std::string_view name, std::int64_t frames = 0) {
  for (const ReproducedDocument& document : reproduced_documents()) {
    if (document.name == name) return reproduce(document, {.jobs = 1, .quiet = true, .frames = frames});
  }
  FAIL("no document " << std::string(name));
  return {};
}

// Numbers everywhere, and a verdict wherever there is a target.
inline void check_rows(const Reproduction& document) {
  CHECK_FALSE(document.rows.empty());
  CHECK_FALSE(document.remarks.empty());
  for (const ReproducedRow& row : document.rows) {
    CAPTURE(row.figure, row.item, row.quantity);
    CHECK(std::isfinite(row.simulated));
    if (row.published) CHECK(std::isfinite(*row.published));
    if (row.certified) CHECK(std::isfinite(*row.certified));
    CHECK((verdict(row) == Verdict::no_target) == !row.target.has_value());
  }
}

// The first row of that quantity whose item is `item`, or goes on after it with ", ".
inline const ReproducedRow& find_row(const Reproduction& document, std::string_view item, std::string_view quantity) {
  for (const ReproducedRow& row : document.rows) {
    const bool is_it = row.item == item || row.item.starts_with(std::string(item) + ", ");
    if (is_it && row.quantity == quantity) return row;
  }
  FAIL("no row " << std::string(item) << ", " << std::string(quantity));
  return document.rows.front();
}

}  // namespace framesim
