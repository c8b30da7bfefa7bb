// No code: its target carries the precompiled header that all tests share.
