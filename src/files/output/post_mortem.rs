//! Post-mortems: a particle that failed numerically, with its neighbours, as text and as HDF5.

use std::fmt::Write as _;
use std::path::Path;

use comm::Comm;
use engine::step::PostMortem;
use model::Case;
use particles::{FieldInfo, FieldKind, HaloPhase, ParticleStore, Select};

use super::checkpoint::row_type;
use super::h5::{Element, RowType, Writer};
use super::{Block, OutputError, files, write_atomically};

/// Writes `STEM.txt` and `STEM.h5`; `what` describes the failure. By the rank that owns the particle.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Hdf5`].
pub fn write(
    stem: &Path,
    what: &str,
    case: &Case,
    particles: &ParticleStore,
    about: &PostMortem,
) -> Result<(), OutputError> {
    if let Some(folder) = stem.parent() {
        files::make_folder(folder)?;
    }
    let text = text(what, case, particles, about);
    write_atomically(&stem.with_extension("txt"), text.as_bytes())?;
    let alone = Comm::solo();
    let mut file = Writer::create(&alone, &stem.with_extension("h5"))?;
    file.number("/", "step", &about.step)?;
    file.number("/", "time", &about.time)?;
    file.number("/", "rank", &(about.rank as u64))?;
    file.text("/what", what)?;
    file.text("/input", &case.resolved)?;
    let (particle, neighbours) = about.members.split_at(1);
    write_fields(
        &mut file,
        "/particle",
        particles,
        particle,
        FieldInfo::is_of_steps,
    )?;
    write_fields(
        &mut file,
        "/neighbours",
        particles,
        neighbours,
        particles.halo_phases() - HaloPhase::SHOWN,
    )?;
    let block = Block::even(about.distances.len() as u64 - 1, 0, 1);
    let bytes = bytemuck::cast_slice(&about.distances[1..]);
    file.rows(
        "/neighbours/distance",
        RowType::single(Element::F64),
        block,
        bytes,
    )?;
    file.close()
}

/// Fields of some particles, in a group of their own.
fn write_fields(
    file: &mut Writer,
    group: &str,
    particles: &ParticleStore,
    members: &[u32],
    which: impl Select,
) -> Result<(), OutputError> {
    file.group(group)?;
    let block = Block::even(members.len() as u64, 0, 1);
    for field in particles.held(which) {
        let row = row_type(field.kind);
        let path = format!("{group}/{}", field.name);
        file.rows(&path, row, block, &gather(particles, field, members))?;
        file.note(&path, "unit", field.unit)?;
    }
    Ok(())
}

/// A field's bytes of some particles; zeros where a particle does not have it now.
fn gather(particles: &ParticleStore, field: &FieldInfo, members: &[u32]) -> Vec<u8> {
    let (size, bytes) = (field.kind.bytes(), particles.bytes(field.id));
    let mut rows = Vec::with_capacity(size * members.len());
    for &i in members {
        let start = i as usize * size;
        match bytes.get(start..start + size) {
            Some(value) => rows.extend_from_slice(value),
            None => rows.resize(rows.len() + size, 0),
        }
    }
    rows
}

fn text(what: &str, case: &Case, particles: &ParticleStore, about: &PostMortem) -> String {
    let particle = about.members[0];
    let body = &case.bodies[particles.body[particle as usize] as usize].name;
    let mut text = format!(
        "Particle {} of body `{body}`, on rank {}, after step {} at {:e} s:\n{what}\n\n",
        about.id, about.rank, about.step, about.time
    );
    append_fields(&mut text, particles, particle);
    append_neighbours(&mut text, case, particles, about);
    text.push_str("\nThe last votes (step, next time step in s, its reason, particle):\n");
    for past in &about.past_steps {
        let _ = writeln!(
            text,
            "{} {:e} {} {}",
            past.step, past.dt, past.reason, past.id
        );
    }
    text
}

/// A line for each field of a particle.
fn append_fields(text: &mut String, particles: &ParticleStore, particle: u32) {
    for field in particles.held(FieldInfo::any) {
        let bytes = gather(particles, field, &[particle]);
        let values = match field.kind {
            FieldKind::Id => {
                vec![u64::from_le_bytes(bytes[..8].try_into().unwrap_or_default()).to_string()]
            }
            FieldKind::Index => {
                vec![u32::from_le_bytes(bytes[..4].try_into().unwrap_or_default()).to_string()]
            }
            _ => bytemuck::pod_collect_to_vec::<u8, f64>(&bytes)
                .iter()
                .map(|x| format!("{x:e}"))
                .collect(),
        };
        let _ = writeln!(
            text,
            "{:24} {} {}",
            field.name,
            values.join(" "),
            field.unit
        );
    }
}

/// A line for each neighbour: those of the particle's own body, then others.
fn append_neighbours(
    text: &mut String,
    case: &Case,
    particles: &ParticleStore,
    about: &PostMortem,
) {
    let own = particles.body[about.members[0] as usize];
    let spacing = case.bodies[own as usize].lattice.spacing;
    for (title, other) in [
        ("Neighbours of its own body", false),
        ("Contact partners", true),
    ] {
        let _ = writeln!(
            text,
            "\n{title}, nearest first (id, body, distance in its spacings, density in kg/m^3, velocity in m/s, owned here):"
        );
        for (&i, r) in about.members.iter().zip(&about.distances).skip(1) {
            let k = i as usize;
            if (particles.body[k] != own) == other {
                let _ = writeln!(
                    text,
                    "{} {} {:.4} {:e} {:?} {}",
                    particles.id[k],
                    case.bodies[particles.body[k] as usize].name,
                    r / spacing,
                    particles.predicted_density[k],
                    particles.predicted_velocity[k],
                    k < particles.owned()
                );
            }
        }
    }
}
