// CSV, with a header and without, between commas, semicolons and blanks.
#include "tests/fuzz/cloud.h"

namespace merlin {

std::vector<Bytes> fuzz::Seeds() {
  std::vector<Bytes> seeds{ToBytes("x,y,z,sigma_m\n1,2,3,1\n4,5,6,0.5\n"),
                           ToBytes("1 2 3\n4 5 6\n"),
                           ToBytes("# a remark\n\"x_m\";\"y_m\";\"z_m\"\r\n1;2;3\r\n"),
                           ToBytes("\xEF\xBB\xBF"
                                   "1\t2\t3\n"),
                           ToBytes("2\n//X Y Z R\n1 2 3 4\n5 6 7 8\n1\n1 2 3 4\n"),
                           ToBytes("1,5;2,5;3,5;\n;;4;wall\n"),
                           ToBytes("# x y z\n1,5 2 3\n"),
                           ToBytes("x,y,z,r,g,b,\n1,2,3,0.5,1,0,\n")};
  for (const char* word : {",", ";", "\"", "red", "sigma"}) seeds.push_back(ToBytes(word));
  AddWords(seeds);
  return seeds;
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Three columns there are at least; this is a line of one or two.
  merlin::fuzz::CheckCloud(merlin::ParseCsv, merlin::fuzz::ToText(data, size), "\n1,2");
  return 0;
}
