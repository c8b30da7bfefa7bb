// Decompresses LZF (M. Lehmann, liblzf), the format of the data in binary_compressed PCD files. The data are a sequence of
// runs, each of which begins with a control byte c:
//   c < 32     c + 1 literal bytes follow.
//   c >= 32    length = c >> 5; if it is 7, the next byte is added to it. distance = (c & 31) * 256 + the next byte. Copy
//              length + 2 bytes that begin distance + 1 bytes back in the output; the copy may overlap its source.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace merlin {

// Returns the `size` bytes that were compressed. Throws InputError (with name and byte; offset: position of the data in the
// file) if the data end within a run, refer to something before their start, or give another number of bytes. Takes memory
// only as far as the data really give bytes, at most 88 times their own size.
std::string DecompressLzf(std::string_view data, std::size_t size, std::size_t offset, const std::string& name);

}  // namespace merlin
