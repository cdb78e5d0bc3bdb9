//! Room plot.
