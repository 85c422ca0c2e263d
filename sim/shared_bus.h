// The bus that uploads and the draws' own fetches share (MachineProfile::bus): who has it, who gets it next. A value
// without a clock or events of its own; the pipeline asks, and tells the time. The rules are in event_engine.h.
#pragma once

#include <cstdint>

#include "sim/machine.h"
#include "sim/units.h"

namespace framesim {

class SharedBus {
 public:
  // A chunk of 0 ps means that there is no bus. Throws InternalError if it is negative.
  explicit SharedBus(const Bus& bus);
  bool exists() const { return chunk_.count() > 0; }
  Picoseconds chunk() const { return chunk_; }

  enum class User : std::uint8_t { none, upload, fetch };
  struct Grant {
    User user = User::none;
    Picoseconds length{0};
  };

  // One upload and one fetch can wait at a time: the first upload in command order whose transfer has not ended, and the
  // fetch of the command in the per-primitive stage. Both longer than 0.
  void ask_upload(Picoseconds length, std::int64_t frame, SimTime asked) { upload_ = {length, frame, asked}; }
  void ask_fetch(Picoseconds length, std::int64_t frame, SimTime asked) { fetch_ = {length, frame, asked}; }
  bool is_free() const { return user_ == User::none; }

  // Gives the bus, if it is free or held by an upload that must give way, to whoever is due; `fetch_allowed` is false
  // while the other client has or wants the GPU. Called once at the end of an instant.
  Grant grant(SimTime now, bool fetch_allowed);
  // Number of the latest grant; a transfer's end that carries another was cut short.
  std::uint64_t turn() const { return turn_; }
  // The transfer of the latest grant is over at `now`. True if that was the last of an upload.
  bool finish(SimTime now);

 private:
  struct Request {
    Picoseconds rest{0};  // still to be granted; 0 = does not ask
    std::int64_t frame = 0;
    SimTime asked{0};
    bool waits() const { return rest.count() > 0; }
  };
  bool fetch_first() const;

  Picoseconds chunk_;
  Arbitration arbitration_;
  Request upload_, fetch_;
  User user_ = User::none;
  SimTime until_{0};  // end of the latest grant
  std::uint64_t turn_ = 0;
};

}  // namespace framesim
