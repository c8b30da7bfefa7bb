// PCD, as text and binary.
#include "tests/fuzz/cloud.h"

namespace merlin {

std::vector<Bytes> fuzz::Seeds() {
  const std::string fields = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  const std::string points = "WIDTH 2\nHEIGHT 1\nPOINTS 2\n";
  const std::string one("\x00\x00\x80\x3f", 4);
  std::vector<Bytes> seeds{ToBytes("# .PCD\n" + fields + "COUNT 1 1 1\n" + points + "DATA ascii\n1 2 3\n4 5 6\n"),
                           ToBytes(fields + points + "DATA binary\n" + one + one + one + one + one + one),
                           ToBytes("FIELDS x y z rgb\nSIZE 8 8 8 1\nTYPE F F F U\nCOUNT 1 1 1 3\nWIDTH 1\nHEIGHT 1\n"
                                   "VIEWPOINT 0 0 0 1 0 0 0\nDATA ascii\n1 2 3 9 8 7\n"),
                           // four bytes as they are, six from four back, fourteen from ten back
                           ToBytes(fields + points + "DATA binary_compressed\n" +
                                   std::string("\x0a\0\0\0\x18\0\0\0\x03zzzz\x80\x03\xe0\x05\x09", 18))};
  for (const char* word :
       {"WIDTH ", "COUNT ", "DATA binary\n", "DATA binary_compressed\n", "F", "8", "18446744073709551615"})
    seeds.push_back(ToBytes(word));
  AddWords(seeds);
  return seeds;
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::fuzz::CheckCloud(merlin::ParsePcd, merlin::fuzz::ToText(data, size), "\n7");
  return 0;
}
