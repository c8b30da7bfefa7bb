// What a scenario, camera or room is, in its author's words.
#pragma once

#include <string>
#include <string_view>

namespace merlin::cli {

// The first sentence of the comment that a YAML or MJCF file begins with; it may span lines, and ends at a full stop, a
// blank line or the comment's end. A full stop in a number or an abbreviation ends none. Empty: the file begins with no
// comment.
std::string FirstSentence(std::string_view text);

}  // namespace merlin::cli
