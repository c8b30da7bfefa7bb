// MERLIN_SIDE_BY_SIDE before a loop tells the compiler that its arrays do not overlap, so that it can vectorise the
// loop. With many arrays it does not check this itself at run time.
#pragma once

#ifdef __clang__
#define MERLIN_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define MERLIN_SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif
