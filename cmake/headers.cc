// No code: its targets carry the precompiled header that libraries share.
