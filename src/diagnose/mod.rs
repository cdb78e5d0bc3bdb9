//! Room diagnose.
