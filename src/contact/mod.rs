//! Room contact.
