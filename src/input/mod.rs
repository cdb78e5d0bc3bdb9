//! Room input.
