const float kNoDepth = -1e30; // where there is no surface: nearer than any
