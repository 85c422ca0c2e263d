#include "sim/shared_bus.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {

SharedBus::SharedBus(const Bus& bus) : chunk_(bus.chunk), arbitration_(bus.arbitration) {
  FRAMESIM_CHECK(chunk_.count() >= 0, fmt::format("a bus with chunks of {} ps", chunk_.count()));
}

// Both ask. An earlier frame comes before a later one, whatever the arbitration.
bool SharedBus::fetch_first() const {
  if (fetch_.frame != upload_.frame) return fetch_.frame < upload_.frame;
  switch (arbitration_) {
    case Arbitration::in_order:
      return fetch_.asked <= upload_.asked;
    case Arbitration::draws_first:
      return true;
    case Arbitration::uploads_first:
      return false;
  }
  fail_check(__FILE__, __LINE__, "a known arbitration", fmt::format("{}", static_cast<int>(arbitration_)));
}

SharedBus::Grant SharedBus::grant(SimTime now, bool fetch_allowed) {
  const bool fetch = fetch_.waits() && fetch_allowed;
  if (user_ == User::upload && fetch && fetch_.frame < upload_.frame) {
    upload_.rest += until_ - now;
    user_ = User::none;
  }
  if (user_ != User::none || !(fetch || upload_.waits())) return {};
  user_ = fetch && (!upload_.waits() || fetch_first()) ? User::fetch : User::upload;
  Request& request = user_ == User::fetch ? fetch_ : upload_;
  const Picoseconds length = std::min(request.rest, chunk_);  // a fetch is at most one chunk
  request.rest -= length;
  until_ = advance(now, length);
  ++turn_;
  return {user_, length};
}

bool SharedBus::finish(SimTime now) {
  const bool upload = user_ == User::upload;
  user_ = User::none;
  if (upload) upload_.asked = now;  // what is left of it asks again
  return upload && !upload_.waits();
}

}  // namespace framesim
