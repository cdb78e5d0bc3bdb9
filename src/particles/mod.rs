//! Room particles.
