#include <string>

#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

// The client that the effect gives to a staged machine.
GpuClient client_of(const char* spec_text, std::uint64_t seed = 1) {
  MachineProfile machine;
  make_effect(spec_text, seed)->on_machine(machine);
  return machine.client;
}

std::string refusal(const char* spec_text) {
  try {
    make_effect(spec_text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("preemption gives the machine a client with its times, a rate or a period alike") {
  const GpuClient client = client_of("preemption:period=8ms,duration=2ms,switch=30us,first=3ms,at=command");
  CHECK(client.period.count() == 8'000'000'000);
  CHECK(client.duration.count() == 2'000'000'000);
  CHECK(client.switch_time.count() == 30'000'000);
  CHECK(client.first.count() == 3'000'000'000);
  CHECK(client.between_commands);
  CHECK_FALSE(client.arrivals);
  CHECK(client_of("preemption:period=125Hz").period.count() == 8'000'000'000);
  CHECK_FALSE(client_of("preemption:at=instant").between_commands);
  CHECK(make_effect("preemption")->hooks() == Hook::machine);
}

// Defaults: a compositor of 60 Hz, the period of vsync:rate=60Hz to the picosecond.
TEST_CASE("the default client comes once in each refresh of 60 Hz") {
  CHECK(client_of("preemption").period.count() == 16'666'666'667);
}

TEST_CASE("poisson arrivals draw from the effect's own stream of the run's seed") {
  const GpuClient client = client_of("preemption:arrivals=poisson", 7);
  REQUIRE(client.arrivals);
  for (std::uint32_t job = 0; job < 10; ++job) {
    CHECK(client.arrivals->bits(0, job) == RandomStream(7, "preemption").bits(0, job));
    CHECK(client.arrivals->bits(0, job) != RandomStream(7, "jitter").bits(0, job));
  }
}

TEST_CASE("preemption is inert without a job or without stages, and says why") {
  EffectRun run;
  CHECK_FALSE(make_effect("preemption")->inert(run.context()));
  CHECK_FALSE(make_effect("preemption:duration=0")->inert(run.context()));  // the switches remain
  CHECK_FALSE(make_effect("preemption:switch=0")->inert(run.context()));
  CHECK(make_effect("preemption:duration=0,switch=0")->inert(run.context())->find("never held") != std::string::npos);
  run.machine.overlap = parse_overlap("paper2005");
  CHECK(make_effect("preemption")->inert(run.context())->find("paper2005 is a closed form") != std::string::npos);
}

// Forced in, at=command too: a job of no length would still wait for the end of commands.
TEST_CASE("inert settings leave the machine without a client") {
  CHECK(client_of("preemption:duration=0,switch=0,at=command").period.count() == 0);
  MachineProfile serial;
  serial.overlap = parse_overlap("serial");
  make_effect("preemption")->on_machine(serial);
  CHECK(serial.client.period.count() == 0);
}

// 4 ms + 2 * 3 ms = 10 ms is the whole period; a microsecond more of it is enough.
TEST_CASE("a client that leaves nothing of the GPU is refused with what is allowed") {
  const std::string message = refusal("preemption:period=10ms,duration=4ms,switch=3ms");
  CAPTURE(message);
  CHECK(message.find("10ms") != std::string::npos);
  CHECK(message.find("duration + 2*switch below the period") != std::string::npos);
  CHECK(refusal("preemption:period=10.001ms,duration=4ms,switch=3ms").empty());
  CHECK_FALSE(refusal("preemption:period=1000Hz").empty());  // the default job takes 1.1 ms
}

TEST_CASE("preemption refuses words that are none of its own") {
  for (const char* wrong : {"preemption:period=0", "preemption:period=16", "preemption:duration=-1ms",
                            "preemption:at=triangle", "preemption:arrivals=burst", "preemption:rate=60Hz"}) {
    CAPTURE(wrong);
    CHECK_FALSE(refusal(wrong).empty());
  }
  CHECK(refusal("preemption:arrivals=poisson,first=2ms").find("arrivals=periodic") != std::string::npos);
  CHECK(refusal("preemption:first=2ms,arrivals=periodic").empty());
}
