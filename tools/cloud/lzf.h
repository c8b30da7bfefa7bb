// LZF (M. Lehmann's liblzf), in which PCD files of the kind binary_compressed hold their data. A control byte c comes
// first. Below 32: c + 1 bytes follow as they are. Else its upper three bits are a length, 7 meaning that a byte more
// is to be added, and its lower five with the next byte a distance: so many bytes + 2 are repeated from so far + 1
// back, from what is being written where they overlap.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace merlin {

// The bytes that were compressed, `size` of them. Throws InputError (name, byte; offset: where in the file the data
// begin) for data that end within a run, repeat what is before their start, or give another number of bytes. Takes
// memory only as the data give bytes: at most 88 times theirs.
std::string DecompressLzf(std::string_view data, std::size_t size, std::size_t offset, const std::string& name);

}  // namespace merlin
