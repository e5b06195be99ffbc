//! Experience logs in the l2logger format and the lifelong-learning metrics computed from them.
