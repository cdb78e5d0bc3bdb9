//! Triangles from Wavefront OBJ files: places and faces alone, whatever else they have for pictures.

use model::triangulate;

/// Statements that say nothing of the surface: texture, normals, groups, lines, materials, looks.
const OTHERS: &[&str] = &[
    "vt",
    "vn",
    "vp",
    "p",
    "l",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "call",
    "csh",
];
/// Statements of curved surfaces.
const CURVED: &[&str] = &[
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp",
    "end", "con", "bzp", "bsp", "cdc", "cdp", "res", "ctech", "stech",
];

/// Work on faces, by the squares of their corners, for each byte of a file, and of any file: that of
/// a face grows faster than its line.
const WORK: usize = 8;
const LEAST_WORK: usize = 1 << 24;

/// The triangles of a content, in its own units. Faces with more corners are cut into triangles.
///
/// # Errors
/// The fault, with the line.
pub fn triangles(bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, String> {
    let mut places: Vec<[f64; 3]> = Vec::new();
    let mut soup = Vec::new();
    let mut work = LEAST_WORK + WORK * bytes.len();
    for (line, text) in statements(bytes) {
        let failed = |why: String| Err(format!("line {line}: {why}"));
        let mut words = text.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("v") => match place(words) {
                Some(place) => places.push(place),
                None => return failed("a `v` must be followed by three numbers".to_owned()),
            },
            Some("f") => {
                let face: Result<Vec<[f64; 3]>, String> =
                    words.map(|word| corner(word, &places)).collect();
                let face = match face {
                    Ok(face) => face,
                    Err(why) => return failed(why),
                };
                let Some(left) = work.checked_sub(face.len().pow(2)) else {
                    let why = "too many faces have too many corners; save it as triangles";
                    return failed(why.to_owned());
                };
                work = left;
                let Some(cut) = triangulate(&face) else {
                    return failed(no_polygon(face.len()));
                };
                soup.extend(cut.into_iter().map(|t| t.map(|c| face[c])));
            }
            Some(word) if OTHERS.contains(&word) => {}
            Some(word) if CURVED.contains(&word) => {
                let why = format!("`{word}` is of a curved surface; save it as triangles");
                return failed(why);
            }
            Some(word) => {
                let word: String = word.chars().take(20).collect();
                return failed(format!("`{word}` is no statement of an OBJ file"));
            }
        }
    }
    if soup.is_empty() {
        return Err("it is no OBJ file with faces: no line begins with `f`".to_owned());
    }
    Ok(soup)
}

/// The statements of a content with the numbers of their lines, without comments. One that ends with
/// `\` goes on in the next line.
fn statements(bytes: &[u8]) -> impl Iterator<Item = (usize, String)> {
    let mut lines = (1..).zip(bytes.split(|&b| b == b'\n'));
    std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        let mut text = String::from_utf8_lossy(first).into_owned();
        while text.trim_end().ends_with('\\') {
            text.truncate(text.trim_end().len() - 1);
            let Some((_, next)) = lines.next() else { break };
            text.push(' ');
            text.push_str(&String::from_utf8_lossy(next));
        }
        if let Some(comment) = text.find('#') {
            text.truncate(comment);
        }
        Some((number, text))
    })
}

fn place<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let mut place = [0.0; 3];
    for x in &mut place {
        *x = words.next()?.parse().ok().filter(|x: &f64| x.is_finite())?;
    }
    Some(place)
}

/// The place that a word such as `7`, `7/1/2`, `7//2` or `-1` names.
fn corner(word: &str, places: &[[f64; 3]]) -> Result<[f64; 3], String> {
    let shown = || word.chars().take(40).collect::<String>();
    let number = word.split('/').next().unwrap_or_default();
    let Ok(number) = number.parse::<i64>() else {
        return Err(format!("`{}` is no corner of a face", shown()));
    };
    // From one on, or back from the last.
    let index = if number > 0 {
        usize::try_from(number - 1).ok()
    } else {
        let back = usize::try_from(number.unsigned_abs()).ok();
        back.filter(|&n| n > 0)
            .and_then(|n| places.len().checked_sub(n))
    };
    let found = index.and_then(|n| places.get(n)).copied();
    found.ok_or_else(|| {
        let count = places.len();
        format!("`{}` names none of the {count} places before it", shown())
    })
}

fn no_polygon(corners: usize) -> String {
    match corners {
        0..3 => "a face must have three corners at least".to_owned(),
        2001.. => "a face may have 2000 corners at most".to_owned(),
        _ => "the edges of the face cross, or it has no area".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(text: &str) -> Result<usize, String> {
        triangles(text.as_bytes()).map(|soup| soup.len())
    }

    const SQUARE: &str = "# a square\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 .2 .3 .4\nv 0 1 0\n";

    #[test]
    fn faces_of_any_number_of_corners() {
        assert_eq!(count(&format!("{SQUARE}f 1 2 3\n")), Ok(1));
        assert_eq!(count(&format!("{SQUARE}f 1 2 3 4\n")), Ok(2));
        assert_eq!(
            count(&format!("{SQUARE}f -4/1/1 -3//7 -2/ \\\n -1 # all\n")),
            Ok(2)
        );
        let more = "o a\ng b c\ns off\nusemtl grey\nvt .5\nvn 0 0 1\nl 1 2 3 4\r\nf 1 2 3 4\r\n";
        assert_eq!(count(&format!("{SQUARE}{more}")), Ok(2));
        let soup = triangles(format!("{SQUARE}f 2 3 4\n").as_bytes()).unwrap();
        assert_eq!(soup, [[[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (line, said) in [
            ("v 0 0", "line 6: a `v` must be followed by three numbers"),
            (
                "v 0 0 inf",
                "line 6: a `v` must be followed by three numbers",
            ),
            ("f 1 2", "line 6: a face must have three corners at least"),
            (
                "f 1 2 5",
                "line 6: `5` names none of the 4 places before it",
            ),
            ("f 1 2 0", "line 6: `0` names none"),
            ("f 1 2 -5", "line 6: `-5` names none"),
            ("f 1 2 -9223372036854775808", "names none"),
            ("f 1 2 x", "line 6: `x` is no corner of a face"),
            ("f 1 3 2 4", "line 6: the edges of the face cross"),
            (
                "f 1 1 1 1",
                "line 6: the edges of the face cross, or it has no area",
            ),
            (
                "surf 0 1 0 1 1 2 3 4",
                "line 6: `surf` is of a curved surface",
            ),
            ("facet normal 0 0 1", "line 6: `facet` is no statement"),
            ("", "no line begins with `f`"),
        ] {
            let error = count(&format!("{SQUARE}{line}\n")).unwrap_err();
            assert!(error.contains(said), "{line}: {error}");
        }
        // Short lines that take long.
        let face: Vec<String> = (1..=1500).map(|k| format!(" -{k}")).collect();
        let places: Vec<String> = (0..1500).map(|k| format!("v {k} {} 0\n", k * k)).collect();
        let many = places.concat() + &format!("f{}\n", face.concat()).repeat(16);
        let error = count(&many).unwrap_err();
        assert!(error.contains("line 1508: too many faces"), "{error}");
        assert!(triangles(&[0xff, 0, 0xfe, b'\n', b'\\']).is_err());
        assert!(triangles(b"").is_err());
    }
}
