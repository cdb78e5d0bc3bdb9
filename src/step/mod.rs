//! Room step.
