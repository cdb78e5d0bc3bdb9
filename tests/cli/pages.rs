//! The pages of the book and the README: their links, the places that links lead to, and commands.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A page.
pub struct Page {
    /// Its path from the root of the project.
    pub name: String,
    /// Where it is.
    pub path: PathBuf,
    /// Its Markdown.
    pub text: String,
}

/// All pages of the book, and the README.
pub fn pages() -> Vec<Page> {
    let root = crate::project::root();
    let mut paths = vec![root.join("README.md")];
    gather(&root.join("docs/src"), &mut paths);
    paths.sort();
    let page = |path: PathBuf| Page {
        name: path.strip_prefix(root).unwrap().display().to_string(),
        text: fs::read_to_string(&path).expect("a page is read"),
        path,
    };
    paths.into_iter().map(page).collect()
}

fn gather(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the book") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            gather(&path, paths);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            paths.push(path);
        }
    }
}

impl Page {
    /// Targets of links and pictures.
    pub fn links(&self) -> Vec<String> {
        let text = prose(&self.text);
        let behind = text.split("](").skip(1);
        let target = |rest: &str| rest.split(')').next().map(|link| link.trim().to_owned());
        behind.filter_map(target).collect()
    }

    /// Where a path of a link of this page leads; the page itself if it is empty.
    pub fn resolve(&self, path: &str) -> PathBuf {
        if path.is_empty() {
            return self.path.clone();
        }
        let mut target = self.path.parent().expect("a folder").to_path_buf();
        for part in path.split('/') {
            match part {
                "." => {}
                ".." => {
                    target.pop();
                }
                part => target.push(part),
            }
        }
        target
    }

    /// The names of its headings in links, as mdBook makes them.
    pub fn anchors(&self) -> Vec<String> {
        let mut times: BTreeMap<String, usize> = BTreeMap::new();
        let text = without_blocks(&self.text);
        let headings = text.lines().filter_map(|line| {
            let heading = line.trim_start_matches('#');
            (heading.len() < line.len()).then(|| heading.strip_prefix(' '))?
        });
        let name = |heading: &str| {
            let name = anchor(heading);
            let before = times.entry(name.clone()).or_default();
            *before += 1;
            match *before {
                1 => name,
                more => format!("{name}-{}", more - 1),
            }
        };
        headings.map(name).collect()
    }
}

fn anchor(heading: &str) -> String {
    // Of a link in a heading its text stays.
    let shown = heading.trim().split("](").enumerate();
    let shown = shown.map(|(n, part)| match n {
        0 => part,
        _ => part.split_once(')').map_or("", |(_, rest)| rest),
    });
    let shown: String = shown.collect();
    let letters = shown.chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        letter if letter.is_alphanumeric() => Some(letter.to_ascii_lowercase()),
        _ => None,
    });
    letters.collect()
}

/// The text without code, in which brackets are no links.
fn prose(text: &str) -> String {
    let text = without_blocks(text);
    let parts = text.split('`').enumerate();
    parts
        .map(|(n, part)| if n % 2 == 0 { part } else { "`" })
        .collect()
}

/// The text without blocks of code.
fn without_blocks(text: &str) -> String {
    let mut inside = false;
    let lines = text.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        !inside && !fence
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A block of code.
pub struct Block {
    /// What it is, as `sh`.
    pub kind: String,
    /// Its lines.
    pub text: String,
}

/// The blocks of code of a text.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut all: Vec<Block> = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        if let Some(kind) = line.trim_start().strip_prefix("```") {
            inside = !inside;
            if inside {
                all.push(Block {
                    kind: kind.to_owned(),
                    text: String::new(),
                });
            }
        } else if inside {
            let block = all.last_mut().expect("one has begun");
            block.text.push_str(line);
            block.text.push('\n');
        }
    }
    all
}

/// What the commands of a page hand to the program: those of blocks `sh` and `bash`, and those in the text that
/// stand for nothing else (no `…`, no word in capitals).
pub fn commands(text: &str) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for Block { kind, text } in blocks(text) {
        if ["sh", "bash"].contains(&&*kind) {
            let whole = text.replace("\\\n", "");
            let lines = whole.lines().flat_map(split);
            all.extend(lines.filter_map(|words| given(&words)));
        }
    }
    all.extend(without_blocks(text).lines().flat_map(inline));
    all
}

/// Commands in a line of text.
fn inline(line: &str) -> Vec<Vec<String>> {
    let codes = line.split('`').skip(1).step_by(2);
    let whole = codes.filter(|code| code.starts_with("whipple ") && !code.contains('…'));
    // One that ends with an option tells of that option alone.
    let whole = whole.filter(|code| {
        !code
            .rsplit(' ')
            .next()
            .is_some_and(|last| last.starts_with("--"))
    });
    let words = whole.flat_map(split).filter_map(|words| given(&words));
    let named = |word: &String| {
        let name = word.rsplit(['/', '=', ',']).next().unwrap_or_default();
        name.chars().any(|c| c.is_ascii_uppercase())
            && !name.chars().any(|c| c.is_ascii_lowercase())
    };
    words.filter(|words| !words.iter().any(named)).collect()
}

/// What of a command line the program is given: that behind its own name, whoever starts it.
fn given(words: &[String]) -> Option<Vec<String>> {
    let at = words
        .iter()
        .position(|word| word.rsplit('/').next() == Some("whipple") && !word.starts_with('-'));
    if let Some(at) = at {
        let starts = words[..at].iter().all(|word| {
            let launcher = ["mpirun", "srun", "time", "apptainer", "exec"].contains(&word.as_str());
            launcher || word.starts_with('-') || word.parse::<u32>().is_ok() || word.contains('=')
        });
        return (starts && at + 1 < words.len()).then(|| words[at + 1..].to_vec());
    }
    if words.first().map(String::as_str) != Some("jobs/run.sh") {
        return None;
    }
    // `jobs/run.sh [-n RANKS] [-t THREADS] [restart] CASE …`
    let mut rest = &words[1..];
    while let [option, _, more @ ..] = rest
        && ["-n", "-t"].contains(&option.as_str())
    {
        rest = more;
    }
    let goes_on = rest.first().is_some_and(|word| word == "restart");
    let verb = (!goes_on).then(|| "run".to_owned());
    Some(verb.into_iter().chain(rest.iter().cloned()).collect())
}

/// The commands of a line, as words.
fn split(line: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut word: Option<String> = None;
    let mut quote = None;
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        let end = quote.is_none() && (letter.is_whitespace() || "|;&><#".contains(letter));
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (None, '\\') => word.get_or_insert_default().extend(letters.next()),
            (None, '#') if word.is_some() => word.get_or_insert_default().push(letter),
            _ if !end => word.get_or_insert_default().push(letter),
            _ => {
                let last = commands.last_mut().expect("there is always one");
                last.extend(word.take());
                match letter {
                    '#' => break,
                    '|' | ';' | '&' => commands.push(Vec::new()),
                    // A file follows, which is no word of the command.
                    '>' | '<' => commands.push(vec![String::new()]),
                    _ => {}
                }
            }
        }
    }
    let last = commands.last_mut().expect("there is always one");
    last.extend(word);
    commands
}

/// The messages that a page explains: what stands as code in the first cells of its tables.
pub fn messages(text: &str) -> Vec<String> {
    let mut explains = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if !line.starts_with('|') {
            explains = false;
        } else if line.starts_with("| it says |") {
            explains = true;
        } else if explains && let Some(message) = line.strip_prefix("| `") {
            let end = message.find("` |").expect("the end of the cell");
            found.push(message[..end].to_owned());
        }
    }
    found
}

/// The source as one text in which strings stand as they are said: without ends of lines within
/// them, and without the marks of code.
pub fn said() -> String {
    let mut said = String::new();
    gather_source(&crate::project::root().join("src"), &mut said);
    said.replace("\\\"", "\"").replace('`', "")
}

fn gather_source(folder: &Path, said: &mut String) {
    for entry in fs::read_dir(folder).expect("a folder of the source") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            gather_source(&path, said);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&path).expect("source is read");
            let mut goes_on = false;
            for line in text.lines() {
                let line = if goes_on { line.trim_start() } else { line };
                goes_on = line.ends_with('\\');
                said.push_str(line.trim_end_matches('\\'));
                if !goes_on {
                    said.push('\n');
                }
            }
        }
    }
}
