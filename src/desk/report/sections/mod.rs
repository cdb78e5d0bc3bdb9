//! The sections of a page, one file each. Each is handed the run and gives its piece, or a sentence that
//! says what is missing for it.

pub mod case;
pub mod contacts;
pub mod energies;
pub mod environment;
pub mod figures;
pub mod fragments;
pub mod load;
pub mod measures;
pub mod pictures;
pub mod steps;
pub mod verdict;
