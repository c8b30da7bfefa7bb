// Finds the sentence by which the author of a scenario, camera or room file describes it.
#pragma once

#include <string>
#include <string_view>

namespace merlin::cli {

// The first sentence of the comment at the start of a YAML or MJCF file. It may span several lines, and ends at a full stop,
// at a blank line or with the comment. A full stop in a number or an abbreviation does not end it. Empty if the file does not
// start with a comment.
std::string FirstSentence(std::string_view text);

}  // namespace merlin::cli
