//! Room sph.
