// MERLIN_SIDE_BY_SIDE: put before a loop to tell the compiler that its arrays do not overlap, so that it may vectorise the
// loop. With many arrays it gives up checking this itself at run time.
#pragma once

#ifdef __clang__
#define MERLIN_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define MERLIN_SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif
