#include "experiments/progress.h"

#include <fmt/format.h>

#include <cstdio>

#include "experiments/terminal.h"

namespace framesim {
namespace {
constexpr std::chrono::milliseconds kBetweenDraws{100};
constexpr int kBarWidth = 24;

std::string show_seconds(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  return whole < 60 ? fmt::format("{}s", whole) : fmt::format("{}m{:02}s", whole / 60, whole % 60);
}
}  // namespace

Progress::Progress(std::string unit, std::int64_t total, bool quiet)
    : unit_(std::move(unit)),
      total_(total),
      visible_(!quiet && total > 0 && is_terminal(stderr)),
      color_(wants_color(stderr)),
      start_(Clock::now()),
      next_draw_(start_ + kBetweenDraws) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::advance() {
  const std::int64_t done = ++done_;
  if (!visible_) return;
  const std::unique_lock lock(drawing_, std::try_to_lock);
  if (!lock.owns_lock() || Clock::now() < next_draw_) return;  // somebody else is drawing, or has just drawn
  draw(done);
  next_draw_ = Clock::now() + kBetweenDraws;
}

void Progress::draw(std::int64_t done) {
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  const int filled = static_cast<int>(share * kBarWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
  const std::string_view on = color_ ? "\033[36m" : "", off = color_ ? "\033[0m" : "";
  fmt::print(stderr, "\r{}[{}]{} {}/{} {}, about {} left\033[K", on, bar, off, done, total_, unit_,
             show_seconds(elapsed_s * (1 - share) / share));
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace framesim
