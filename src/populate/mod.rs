//! Room populate.
