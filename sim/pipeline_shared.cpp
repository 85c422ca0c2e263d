// What a shared bus and another client of the GPU add to the pipeline.
#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/pipeline_state.h"

namespace framesim {

void PipelineState::take_shared(const Event& event) {
  switch (event.phase) {
    case Phase::transfer_done:
      if (event.payload == bus_.turn()) finish_transfer();
      break;
    case Phase::bus_grant:
      grant_bus();
      break;
    case Phase::job_arrives:
      client_.arrive();
      closed_ = true;
      schedule_next_job();
      break;
    case Phase::job_leaves:
      give_gpu_back();
      break;
    case Phase::job_takes_gpu:
      take_gpu();
      break;
    default:
      fail_check(__FILE__, __LINE__, "an event of bus or client",
                 fmt::format("phase {}", static_cast<int>(event.phase)));
  }
}

// After each event: a job that waits may have been waiting for it, and the wait for the bus may have begun or ended.
void PipelineState::note_shared() {
  if (client_.waits() && !job_start_due_ && job_may_start()) {
    job_start_due_ = true;
    events_.schedule(events_.now(), Phase::job_takes_gpu, 0);
  }
  if (bus_.exists()) note_bus_wait();
}

// The per-primitive stage waits for the bus while its command waits for a grant, or it is free and the next command's
// upload has not ended; but what the client holds is the client's.
void PipelineState::note_bus_wait() {
  const bool grant = primitive_.state == Server::waits_for_bus;
  const bool upload =
      primitive_.state == Server::idle && primitive_begun_ < submitted_ && uploaded_ == primitive_begun_;
  const bool waits = (grant || upload) && !client_.holds();
  if (waits == waits_for_bus_) return;
  if (waits_for_bus_) frame(waiting_frame_).bus_wait += events_.now() - waits_since_;
  waits_for_bus_ = waits;
  if (!waits) return;
  waits_since_ = events_.now();
  waiting_frame_ = (*ring_)[grant ? primitive_begun_ - 1 : primitive_begun_].frame;
}

// Row `i` of the columns is submitted as `command`.
void PipelineState::note_transfers(PipelineCommand& command, std::size_t i) {
  const CommandColumns& columns = work_->commands;
  command.submitted = events_.now();
  command.upload = Picoseconds(columns.upload_ps.empty() ? 0 : columns.upload_ps[i]);
  command.fetch = Picoseconds(columns.fetch_ps.empty() ? 0 : columns.fetch_ps[i]);
  FRAMESIM_CHECK(
      command.upload.count() >= 0 && command.fetch.count() >= 0 &&
          command.fetch <= std::min(command.primitive, bus_.chunk()),
      fmt::format("at simulated time {} ps a command with a duration of {} ps in the per-primitive stage has "
                  "an upload of {} ps and a fetch of {} ps; a chunk is {} ps",
                  events_.now().count(), command.primitive.count(), command.upload.count(), command.fetch.count(),
                  bus_.chunk().count()));
  if (uploaded_ + 1 == submitted_) next_upload();
}

// Goes on to the next command that has something to upload, which asks as of when it was submitted.
void PipelineState::next_upload() {
  while (uploaded_ < submitted_ && (*ring_)[uploaded_].upload.count() == 0) ++uploaded_;
  if (uploaded_ == submitted_) return;
  const PipelineCommand& command = (*ring_)[uploaded_];
  bus_.ask_upload(command.upload, command.frame, command.submitted);
  if (bus_.is_free()) decide_bus();
}

// At the end of this instant.
void PipelineState::decide_bus() {
  if (bus_decision_due_) return;
  bus_decision_due_ = true;
  events_.schedule(events_.now(), Phase::bus_grant, 0);
}

void PipelineState::grant_bus() {
  bus_decision_due_ = false;
  const SharedBus::Grant grant = bus_.grant(events_.now(), !closed_);
  if (grant.user == SharedBus::User::none) return;
  note(grant.user == SharedBus::User::fetch ? Passage::fetch : Passage::upload, 0, grant.length);
  events_.schedule(after(events_.now(), grant.length), Phase::transfer_done, bus_.turn());
  if (grant.user == SharedBus::User::fetch) {
    begin_work(primitive_, Phase::primitive_done, (*ring_)[primitive_begun_ - 1].primitive);
  }
}

void PipelineState::finish_transfer() {
  if (bus_.finish(events_.now())) {
    ++uploaded_;
    next_upload();
    settle();
  }
  decide_bus();
}

void PipelineState::schedule_next_job() {
  if (const auto arrival = client_.next_arrival(events_.now())) events_.schedule(*arrival, Phase::job_arrives, 0);
}

// Between commands: once no stage works on a command of the oldest frame. Where it is at all in the per-pixel stage,
// that stage has its oldest command.
bool PipelineState::job_may_start() {
  if (!client_.between_commands()) return true;
  if (pixel_.state == Server::works) return false;
  return primitive_.state != Server::works || (*ring_)[primitive_begun_ - 1].frame != (*ring_)[pixel_begun_].frame;
}

void PipelineState::take_gpu() {
  job_start_due_ = false;
  client_since_ = events_.now();
  suspend(primitive_);
  suspend(pixel_);
  events_.schedule(client_.take(events_.now()), Phase::job_leaves, 0);
}

void PipelineState::give_gpu_back() {
  client_.leave();
  note(Passage::client_end, 0, events_.now() - client_since_);
  closed_ = client_.waits();
  if (closed_) return;
  resume(primitive_, Phase::primitive_done);
  resume(pixel_, Phase::pixel_done);
  settle();
  if (bus_.exists()) decide_bus();
}

void PipelineState::suspend(Stage& stage) {
  if (stage.state != Server::works) return;
  stage.state = Server::suspended;
  stage.rest = stage.end - events_.now();
  ++stage.turn;
}

void PipelineState::resume(Stage& stage, Phase phase) {
  if (stage.state == Server::suspended) begin_work(stage, phase, stage.rest);
}

}  // namespace framesim
