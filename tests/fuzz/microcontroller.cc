// Both directions of the microcontroller's line: whatever arrives, a good frame after it is decoded, the counters stay
// consistent, and every decoded message can be encoded again.
#include "robot/protocol/microcontroller.h"

#include <variant>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

using namespace microcontroller;
using std::chrono::milliseconds;

const Bytes kCommandWire = Encode(ToMicro(Command{1000, 0.5, -0.2, milliseconds(250)}), 7);
const Bytes kStateWire = Encode(ToHost(State{.micro_time_ms = 5000, .encoder_counts = -3, .battery_v = 7.2}), 9);

template <class Message>
void Check(BytesView input, const Bytes& good) {
  Decoder<Message> decoder;
  std::size_t read = 0;
  for (const auto& [sequence, message] : decoder.Feed(input)) {
    ++read;
    Decoder<Message> again;
    const auto said_again = again.Feed(Encode(message, sequence));
    fuzz::Expect(said_again.size() == 1 && said_again[0].message == message, "a message that was read is read again");
  }
  fuzz::Expect(decoder.counters().frames == read, "each message is counted");
  fuzz::Expect(decoder.counters().garbage_bytes <= input.size(), "no more bytes are thrown away than came");
  fuzz::Expect(decoder.Feed(good).size() >= 1, "a good frame is read whatever came before it");
  fuzz::Expect(decoder.counters().garbage_bytes <= input.size(), "no byte of a good frame is thrown away");
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  return {kCommandWire, kStateWire, Encode(ToMicro(Hello{}), 1), Encode(ToMicro(PanCommand{1.0}), 2),
          Encode(ToHost(HelloReply{.firmware = "merlin"}), 3)};
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::Check<merlin::microcontroller::ToMicro>({data, size}, merlin::kCommandWire);
  merlin::Check<merlin::microcontroller::ToHost>({data, size}, merlin::kStateWire);
  return 0;
}
