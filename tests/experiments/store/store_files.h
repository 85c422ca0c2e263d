// What tests of the store share: a small sweep, and everything that a store holds as text.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "experiments/store/sqlite.h"
#include "tests/experiments/program.h"

namespace framesim {

// 2 policies x 2 targets x 3 seeds = 12 runs of 20 frames, with noise, so that the seed counts.
inline const char* const kSmallSweep = R"(framesim = 1
scenes = ["street"]
policies = ["robin-hood", "static"]
targets = ["16ms", "33ms"]
effects = ["jitter:sigma=0.1"]
seeds = 3
frames = 20
frame_rows = true
)";

// Every row of every table, numbers bit for bit.
inline std::string content_of_store(const std::string& path) {
  const Database database(path, Database::Open::read_only);
  std::string content;
  Statement tables = database.prepare("SELECT name, sql FROM sqlite_master ORDER BY name");
  while (tables.step()) {
    content += fmt::format("{}: {}\n", tables.text(0), tables.text(1));
    if (!tables.text(1).starts_with("CREATE TABLE")) continue;
    Statement rows = database.prepare("SELECT * FROM " + tables.text(0) + " ORDER BY 1, 2");
    while (rows.step()) {
      for (int i = 0; i < rows.columns(); ++i) {
        content +=
            rows.is_null(i) || rows.is_text(i) || rows.is_whole(i) ? rows.text(i) : fmt::format("{:a}", rows.number(i));
        content += '|';
      }
      content += '\n';
    }
  }
  return content;
}

inline std::int64_t count_in_store(const std::string& path, const std::string& table) {
  return Database(path, Database::Open::read_only).whole("SELECT count(*) FROM " + table);
}

}  // namespace framesim
