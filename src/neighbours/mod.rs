//! Room neighbours.
