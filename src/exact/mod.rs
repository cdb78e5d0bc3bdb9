//! Room exact.
