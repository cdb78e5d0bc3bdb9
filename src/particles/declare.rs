//! Declarations by the rows of the table of fields: names of the fields, the table and the store.

macro_rules! kind_type {
    (Scalar) => {
        f64
    };
    (Vector) => {
        [f64; 3]
    };
    (Symmetric) => {
        [f64; 6]
    };
    (Tensor) => {
        [f64; 9]
    };
    (Id) => {
        u64
    };
    (Index) => {
        u32
    };
}

/// A set of flags, `-` for none.
macro_rules! set {
    ($set:ident: -) => {
        $set::empty()
    };
    ($set:ident: $($flag:ident)|+) => {
        $set::empty()$(.union($set::$flag))+
    };
}

/// The rule that a row states, or that of its kind.
macro_rules! mirror {
    ($kind:ident) => {
        FieldKind::$kind.mirror()
    };
    ($kind:ident $mirror:ident) => {
        Mirror::$mirror
    };
}

macro_rules! kept {
    () => {
        false
    };
    (kept) => {
        true
    };
}

macro_rules! particle_fields {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident: $kind:ident $(as $mirror:ident)?, $unit:literal, $life:ident,
        $($halo:tt)|+, $output:ident, $($owner:tt)|+ $(, $kept:ident)?;
    )+) => {
        /// Names a field of the table.
        #[allow(non_camel_case_types, reason = "variants carry the field's own name")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum FieldId { $( $(#[doc = $doc])+ $name, )+ }

        /// The table.
        pub const FIELDS: &[FieldInfo] = &[ $( FieldInfo {
            id: FieldId::$name,
            name: stringify!($name),
            kind: FieldKind::$kind,
            unit: $unit,
            description: concat!($($doc),+).trim_ascii(),
            mirror: mirror!($kind $($mirror)?),
            life: Life::$life,
            halo: set!(HaloPhase: $($halo)|+),
            output: Output::$output,
            owner: set!(Owner: $($owner)|+),
            kept: kept!($($kept)?),
        }, )+ ];

        // Rows whose columns contradict each other do not compile.
        const _: () = {
            $( FIELDS[FieldId::$name as usize].check(); )+
        };

        /// The particles of one rank: owned ones first, then halo copies of other ranks'
        /// particles (only in fields that halo particles need).
        #[derive(Debug, Clone, Default)]
        pub struct ParticleStore {
            pub(super) owned: usize,
            pub(super) halo: usize,
            pub(super) unused: Owner,
            /// Number of the first owned particles among which the inactive ones stand where they did when it was last taken.
            pub(super) unmoved: usize,
            $( $(#[doc = $doc])+ pub $name: Vec<kind_type!($kind)>, )+
        }

        impl ParticleStore {
            /// A field's values as bytes: owned particles, then (where halo particles have it)
            /// halo particles. Empty for a field that is not held.
            #[must_use]
            pub fn bytes(&self, field: FieldId) -> &[u8] {
                match field { $( FieldId::$name => bytemuck::cast_slice(&self.$name), )+ }
            }

            /// Mutable form of [`Self::bytes`].
            pub fn bytes_mut(&mut self, field: FieldId) -> &mut [u8] {
                match field { $( FieldId::$name => bytemuck::cast_slice_mut(&mut self.$name), )+ }
            }

            /// The arrays of all fields, in the order of the table, to be worked on at once.
            pub(super) fn arrays(&mut self) -> [FieldArray<'_>; FIELDS.len()] {
                [ $( FieldArray::$kind(&mut self.$name), )+ ]
            }

            pub(super) fn free_field(&mut self, field: FieldId) {
                match field { $( FieldId::$name => self.$name = Vec::new(), )+ }
            }

            pub(super) fn gather_field(&mut self, field: FieldId, order: &[u32], scratch: &mut [u64]) {
                match field { $( FieldId::$name => super::arrays::gather(&mut self.$name, order, scratch), )+ }
            }

            pub(super) fn capacity_bytes(&self) -> usize {
                0 $( + self.$name.capacity() * FieldKind::$kind.bytes() )+
            }
        }
    };
}
