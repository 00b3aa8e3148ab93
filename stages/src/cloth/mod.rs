//! The cloth engine that stitchers and drapers share.
