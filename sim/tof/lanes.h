// Before a loop over arrays that do not overlap: the compiler may do several elements at a time. It cannot see that by
// itself where there are more arrays than it checks at run time.
#pragma once

#ifdef __clang__
#define MERLIN_SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#else
#define MERLIN_SIDE_BY_SIDE _Pragma("GCC ivdep")
#endif
