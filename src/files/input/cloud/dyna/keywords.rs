//! Keywords of LS-DYNA: those that are read, those that change no nodes and elements of ours, and
//! those that are refused, which are all others.

use crate::input::cloud::text::shortened;

/// Keywords, each with those that begin with it and `_`, that neither make nor move nodes, solids,
/// shells, particles or their parts before the run.
const HARMLESS: &[&str] = &[
    "AIRBAG",
    "ALE",
    "BOUNDARY",
    "CESE",
    "CHEMISTRY",
    "COMMENT",
    "CONSTRAINED",
    "CONTACT",
    "CONTROL",
    "DAMPING",
    "DATABASE",
    "DEFINE",
    "DEFORMABLE",
    "ELEMENT_BEAM",
    "ELEMENT_DISCRETE",
    "ELEMENT_INERTIA",
    "ELEMENT_MASS",
    "ELEMENT_PLOTEL",
    "ELEMENT_SEATBELT",
    "EM",
    "EOS",
    "FATIGUE",
    "FREQUENCY",
    "HOURGLASS",
    "ICFD",
    "INITIAL",
    "INTEGRATION",
    "INTERFACE",
    "LOAD",
    "MAT",
    "NODE_RIGID_SURFACE",
    "NODE_THICKNESS",
    "PARAMETER_DUPLICATION",
    // One that is used must be set by `*PARAMETER`.
    "PARAMETER_EXPRESSION",
    "PART_ADAPTIVE_FAILURE",
    "PART_ANNEAL",
    "PART_AVERAGED",
    "PART_MODES",
    "PART_SENSOR",
    "RIGIDWALL",
    "RIGID_DEFORMABLE",
    "SECTION",
    "SENSOR",
    "SET",
    "TERMINATION",
    "TITLE",
];

/// Keywords, as far as they are written here, that are refused for reasons of their own.
const REFUSED: &[(&str, &str)] = &[
    ("INCLUDE_", "only plain `*INCLUDE` is read"),
    ("NODE_TRANSFORM", "write the moved nodes"),
    ("NODE_MERGE", "write the merged nodes"),
    ("ELEMENT_SOLID_", "only plain `*ELEMENT_SOLID` is read"),
    ("ELEMENT_GENERATE", "write out its elements"),
    ("ELEMENT_DISCRETE_SPHERE", "write it as `*ELEMENT_SPH`"),
    ("PART_DUPLICATE", "write out its copies"),
    ("PART_STACKED_ELEMENTS", "write out its elements"),
    ("INITIAL_FOAM_REFERENCE_GEOMETRY", "it moves nodes"),
];

/// Options of `*PART` that add cards behind the first two.
const OF_PARTS: &[&str] = &[
    "ATTACHMENT",
    "COMPOSITE",
    "CONTACT",
    "FIELD",
    "INERTIA",
    "NODES",
    "PRINT",
    "REPOSITION",
];

/// Cards of a shell behind that of its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShellCards {
    /// Those that each has.
    pub of_each: usize,
    /// True if one with nodes amid its edges has another.
    pub of_corners: bool,
}

/// Content of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// The beginning of a file, whose line tells its format.
    Keyword,
    Nodes,
    Solids,
    Shells(ShellCards),
    Particles {
        /// True if volumes stand in place of masses.
        is_volume: bool,
    },
    Parts,
    /// A part with more cards than two, of which the others are passed over.
    OnePart,
    /// Motions of parts.
    Move,
    Parameters,
    Include,
    Other,
    End,
}

/// A section by its keyword.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    pub content: Content,
    /// True if integers have ten columns and not eight.
    pub is_wide: bool,
}

/// The section that the line of a keyword begins, in a file of that format.
///
/// # Errors
/// If it is not known to change nothing.
pub fn begin(line: &str, is_wide: bool) -> Result<Section, String> {
    let line = line.to_uppercase();
    let bare = line.split(['(', '$']).next().unwrap_or_default().trim();
    let (name, format) = match bare.split_once(char::is_whitespace) {
        Some((name, format)) => (name, format.trim()),
        None => bare.split_at(bare.trim_end_matches(['+', '-', '%']).len()),
    };
    let content = content(name)?;
    let is_read = !matches!(content, Content::Other | Content::End);
    if is_read && (format.contains("LONG=Y") || format == "+") {
        return Err("the long format is not read: write the standard one".to_owned());
    }
    let is_wide = match format {
        _ if content == Content::Keyword => is_wide || format.contains("I10=Y"),
        "%" => true,
        "-" => false,
        _ => is_wide,
    };
    Ok(Section { content, is_wide })
}

fn content(name: &str) -> Result<Content, String> {
    if let Some((keyword, help)) = REFUSED.iter().find(|(word, _)| name.starts_with(word)) {
        let keyword = keyword.trim_end_matches('_');
        return Err(format!("`*{keyword}…` is not read: {help}"));
    }
    Ok(match name {
        "KEYWORD" | "KEYWORD_ID" | "KEYWORD_JOBID" => Content::Keyword,
        "END" => Content::End,
        "NODE" => Content::Nodes,
        "ELEMENT_SOLID" => Content::Solids,
        "ELEMENT_SPH" => Content::Particles { is_volume: false },
        "ELEMENT_SPH_VOLUME" => Content::Particles { is_volume: true },
        "PART" => Content::Parts,
        "PART_MOVE" => Content::Move,
        "PARAMETER" | "PARAMETER_LOCAL" => Content::Parameters,
        "INCLUDE" => Content::Include,
        _ if HARMLESS.iter().any(|known| is_of(name, known)) => Content::Other,
        _ => {
            let found = shells(name).or_else(|| one_part(name));
            return found.ok_or_else(|| {
                let name = shortened(name);
                format!("`*{name}` is not read, and may change nodes or elements: take it out")
            });
        }
    })
}

/// True of a keyword and those that begin with it and `_`.
fn is_of(name: &str, known: &str) -> bool {
    let rest = name.strip_prefix(known);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

/// Shells with options that say nothing of their nodes.
fn shells(name: &str) -> Option<Content> {
    let options = name.strip_prefix("ELEMENT_SHELL")?;
    let mut has = [false; 3];
    for option in options.split('_').skip(1) {
        let option = match option {
            "THICKNESS" => 0,
            "BETA" | "MCID" => 1,
            "OFFSET" => 2,
            _ => return None,
        };
        has[option] = true;
    }
    let [thickness, angle, offset] = has;
    (options.is_empty() || options.starts_with('_')).then_some(Content::Shells(ShellCards {
        of_each: usize::from(thickness || angle) + usize::from(offset),
        of_corners: thickness,
    }))
}

fn one_part(name: &str) -> Option<Content> {
    let mut options = name.strip_prefix("PART_")?.split('_');
    // Composites have options of their own.
    let is_composite = name.starts_with("PART_COMPOSITE");
    let is_known = is_composite || options.all(|option| OF_PARTS.contains(&option));
    is_known.then_some(Content::OnePart)
}
