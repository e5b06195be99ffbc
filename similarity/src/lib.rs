//! Distances between worlds and between variants, and orderings of them.
