//! Pieces of HTML, in which texts of files cannot become markup.

use model::readable::one_line;
use plot::{Rgb, hex};

/// A piece of a page: markup of our own, and texts that are escaped.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Html(String);

#[expect(
    clippy::needless_pass_by_value,
    reason = "a piece goes into one place of the page"
)]
impl Html {
    /// A text of any origin.
    pub fn text(text: &str) -> Self {
        let mut escaped = String::with_capacity(text.len());
        for c in one_line(text).chars() {
            match c {
                '&' => escaped.push_str("&amp;"),
                '<' => escaped.push_str("&lt;"),
                '>' => escaped.push_str("&gt;"),
                '"' => escaped.push_str("&quot;"),
                '\'' => escaped.push_str("&#39;"),
                c => escaped.push(c),
            }
        }
        Self(escaped)
    }

    /// Markup of the source.
    pub fn own(markup: &'static str) -> Self {
        Self(markup.to_owned())
    }

    /// An element around `inside` with attributes, whose values are escaped.
    pub fn element(name: &'static str, attributes: &[(&'static str, &str)], inside: Self) -> Self {
        let mut markup = format!("<{name}");
        for (attribute, value) in attributes {
            markup.push(' ');
            markup.push_str(attribute);
            markup.push_str("=\"");
            markup.push_str(&Self::text(value).0);
            markup.push('"');
        }
        markup.push('>');
        markup.push_str(&inside.0);
        if !VOID.contains(&name) {
            markup.push_str("</");
            markup.push_str(name);
            markup.push('>');
        }
        Self(markup)
    }

    /// An element without attributes around a text.
    pub fn of(name: &'static str, text: &str) -> Self {
        Self::element(name, &[], Self::text(text))
    }

    /// Data for the script, which no browser runs: JSON or base64, whose `<` are written as in
    /// JSON.
    pub fn data(id: &str, kind: &str, content: &str) -> Self {
        let content = Self(content.replace('<', "\\u003c"));
        Self::element("script", &[("id", id), ("type", kind)], content)
    }

    /// The same with something behind it.
    pub fn then(mut self, next: Self) -> Self {
        self.0.push_str(&next.0);
        self
    }

    /// Adds a piece.
    pub fn push(&mut self, next: Self) {
        self.0.push_str(&next.0);
    }

    /// Bytes.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The markup.
    pub fn into_markup(self) -> String {
        self.0
    }
}

impl FromIterator<Html> for Html {
    fn from_iter<T: IntoIterator<Item = Html>>(pieces: T) -> Self {
        pieces.into_iter().fold(Self::default(), Self::then)
    }
}

/// Elements without content.
const VOID: [&str; 2] = ["img", "input"];

/// A table: names of the columns, and rows of cells.
pub fn table(head: &[&str], rows: impl IntoIterator<Item = Vec<Html>>) -> Html {
    let head = head.iter().map(|name| Html::of("th", name)).collect();
    let cell = |cell: Html| {
        let number = cell
            .0
            .starts_with(|c: char| c.is_ascii_digit() || "-−".contains(c));
        let class = if number { "n" } else { "t" };
        Html::element("td", &[("class", class)], cell)
    };
    let row = |cells: Vec<Html>| Html::element("tr", &[], cells.into_iter().map(cell).collect());
    let body = rows.into_iter().map(row).collect();
    let inside = Html::element("thead", &[], Html::element("tr", &[], head)).then(Html::element(
        "tbody",
        &[],
        body,
    ));
    let table = Html::element("table", &[], inside);
    Html::element("div", &[("class", "wide")], table)
}

/// The same of texts.
pub fn table_of_texts(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Html {
    let row = |cells: Vec<String>| cells.iter().map(|cell| Html::text(cell)).collect();
    table(head, rows.into_iter().map(row))
}

/// Names and what they are, one below the other.
pub fn list<S: AsRef<str>>(entries: impl IntoIterator<Item = (S, String)>) -> Html {
    let entry =
        |(name, value): (S, String)| Html::of("dt", name.as_ref()).then(Html::of("dd", &value));
    Html::element("dl", &[], entries.into_iter().map(entry).collect())
}

/// A paragraph that says what is not there.
pub fn missing(what: &str) -> Html {
    Html::element("p", &[("class", "missing")], Html::text(what))
}

/// A piece, or why it is missing.
pub fn or_reason(piece: Result<Html, String>) -> Html {
    piece.unwrap_or_else(|reason| missing(&format!("Not told: {reason}.")))
}

/// A note below a table or picture.
pub fn note(text: &str) -> Html {
    Html::element("p", &[("class", "note")], Html::text(text))
}

/// A square of a colour, as in a legend.
pub fn swatch(colour: Rgb) -> Html {
    let colour = hex(colour);
    let square = [("width", "12"), ("height", "12"), ("fill", colour.as_str())];
    let attributes = [
        ("class", "swatch"),
        ("viewBox", "0 0 12 12"),
        ("aria-hidden", "true"),
    ];
    Html::element(
        "svg",
        &attributes,
        Html::element("rect", &square, Html::default()),
    )
}

/// A bar of a share, 0 to 1.
pub fn bar(share: f64) -> Html {
    let width = format!("{:.1}", 100.0 * share.clamp(0.0, 1.0));
    let filled = [("width", width.as_str()), ("height", "8")];
    let attributes = [
        ("class", "bar"),
        ("viewBox", "0 0 100 8"),
        ("preserveAspectRatio", "none"),
        ("aria-hidden", "true"),
    ];
    Html::element(
        "svg",
        &attributes,
        Html::element("rect", &filled, Html::default()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_no_markup() {
        let hostile = "</td><script>alert(\"1\" & '2')</script>\u{202e}\n";
        let row = vec![hostile.to_owned(), "-1.5".to_owned()];
        let markup = table_of_texts(&["a", "<b>"], [row]).into_markup();
        assert!(
            !markup.contains("<script") && !markup.contains("<b>"),
            "{markup}"
        );
        assert!(markup.contains("&lt;script&gt;alert(&quot;1&quot; &amp; &#39;2&#39;)"));
        assert!(!markup.contains('\u{202e}') && markup.contains("<td class=\"n\">-1.5"));
        let data = Html::data("d", "application/json", "\"</script><b>\"").into_markup();
        assert_eq!(data.matches('<').count(), 2, "{data}");
        let element = Html::element("img", &[("alt", "\" onload=\"x")], Html::default());
        assert_eq!(element.into_markup(), "<img alt=\"&quot; onload=&quot;x\">");
    }
}
