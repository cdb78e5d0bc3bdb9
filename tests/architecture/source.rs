//! What the lints see of a source file, without comments, strings and unit tests.

use std::mem::replace;

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned as _;
use syn::visit::{self, Visit};
use syn::{Block, Expr, Lit, Member, Token};

/// Crates whose folders are the rooms; each other folder of `src/` is a room itself.
pub const CRATES_OF_ROOMS: &str = "engine files desk";

/// How the iterators of rayon end in one value, in an order which is that of the threads.
const REDUCTIONS: &str = "sum product reduce reduce_with try_reduce fold fold_with";

/// A line and what stands there.
pub type Found = (usize, String);

/// One file of `src/`, as plain values.
#[derive(Default)]
pub struct Source {
    /// Path below `src/`.
    pub path: String,
    pub room: String,
    pub lines: Vec<String>,
    /// Every identifier.
    pub names: Vec<Found>,
    /// `.name(…)`, `.name::<T>(…)` and `f64::name`.
    pub calls: Vec<Found>,
    /// Parallel iterators that end in one value.
    pub reductions: Vec<Found>,
    /// Where one thread goes over all particles of a rank: `0..owned`, or an iterator over a field of the store.
    pub lone_loops: Vec<Found>,
    /// True if a parallel iterator begins with what is visited.
    begins_parallel: bool,
}

/// True if a word stands in a list of words.
pub fn has(words: &str, word: &str) -> bool {
    words.split(' ').any(|other| other == word)
}

impl Source {
    pub fn new(path: &str, text: &str) -> Self {
        let tokens = text.parse().map(without_unit_tests).expect(path);
        // `contact/pair.rs` and `engine/contact/pair.rs` are of the room `contact`.
        let folders = path.rsplit_once('/').map_or("", |(folders, _)| folders);
        let (first, rest) = folders.split_once('/').unwrap_or((folders, ""));
        let inner = rest.split('/').next().unwrap_or_default();
        let is_inner = has(CRATES_OF_ROOMS, first) && !inner.is_empty();
        let mut source = Self {
            path: path.to_owned(),
            room: if is_inner { inner } else { first }.to_owned(),
            lines: text.lines().map(str::to_owned).collect(),
            ..Self::default()
        };
        source.search(tokens.clone());
        source.visit_file(&syn::parse2(tokens).expect(path));
        source
    }

    /// True if a comment on the line, or in the comment above it, has the words.
    pub fn says(&self, line: usize, words: &str) -> bool {
        let above = self.lines[..line - 1].iter().rev();
        let above = above.take_while(|text| text.trim_start().starts_with("//"));
        std::iter::once(&self.lines[line - 1])
            .chain(above)
            .filter_map(|text| text.split_once("//"))
            .any(|(_, comment)| comment.contains(words))
    }

    /// Takes the names from tokens: to `syn` the body of a macro is nothing else.
    fn search(&mut self, tokens: TokenStream) {
        let mut before = String::new();
        let mut rest = tokens.into_iter().peekable();
        while let Some(tree) = rest.next() {
            before = match tree {
                TokenTree::Ident(name) => {
                    let found = (name.span().start().line, name.to_string());
                    let is_called = rest.peek().is_some_and(|next| match next {
                        TokenTree::Group(group) => group.delimiter() == Delimiter::Parenthesis,
                        next => is_mark(next, ':'),
                    });
                    let is_method = is_called && before.ends_with('.') && !before.ends_with("..");
                    if is_method || ["f64::", "f32::"].contains(&before.as_str()) {
                        self.calls.push(found.clone());
                    }
                    self.names.push(found);
                    name.to_string()
                }
                TokenTree::Group(group) => {
                    self.search(group.stream());
                    String::new()
                }
                TokenTree::Punct(mark) => before + &mark.to_string(),
                TokenTree::Literal(_) => String::new(),
            };
        }
    }

    /// Visits arguments or statements in a macro. Of what is neither, as of arms and repetitions, the text tells.
    fn visit_body(&mut self, tokens: TokenStream) {
        let no_variable_mark = |tree: &TokenTree| !is_mark(tree, '$');
        let tokens: TokenStream = tokens.into_iter().filter(no_variable_mark).collect();
        if let Ok(arguments) =
            Punctuated::<Expr, Token![,]>::parse_terminated.parse2(tokens.clone())
        {
            for argument in &arguments {
                self.visit_expr(argument);
            }
        } else if let Ok(statements) = Block::parse_within.parse2(tokens.clone()) {
            for statement in &statements {
                self.visit_stmt(statement);
            }
        } else {
            let line = tokens.span().start().line;
            let mut text = String::new();
            for tree in tokens {
                match tree {
                    TokenTree::Group(group) => self.visit_body(group.stream()),
                    tree => text += &tree.to_string(),
                }
            }
            let is_reduced = |word: &str| text.contains(&format!(".{word}"));
            if text.contains("par_") && REDUCTIONS.split(' ').any(is_reduced) {
                let what = "parallel reduction in a macro";
                self.reductions.push((line, what.to_owned()));
            }
            let iterates = text.contains("particles.") && text.contains(".iter");
            if iterates || text.contains("0..owned") || text.contains("0..particles.owned") {
                self.push_lone_loop(line);
            }
        }
    }

    fn push_lone_loop(&mut self, line: usize) {
        self.lone_loops.push((line, "one thread alone".to_owned()));
    }
}

impl<'ast> Visit<'ast> for Source {
    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let name = call.method.to_string();
        let begins = self.begins_parallel || begins_parallel(&name);
        if has("iter iter_mut", &name) && !begins && is_field_of_particles(&call.receiver) {
            self.push_lone_loop(call.span().start().line);
        }
        if has(REDUCTIONS, &name) && is_parallel(&call.receiver) {
            let line = call.method.span().start().line;
            self.reductions.push((line, format!("parallel {name}")));
        }
        let outside = replace(&mut self.begins_parallel, begins);
        self.visit_expr(&call.receiver);
        self.begins_parallel = outside;
        for argument in &call.args {
            self.visit_expr(argument);
        }
    }

    fn visit_expr_range(&mut self, range: &'ast syn::ExprRange) {
        let starts_at_0 = matches!(range.start.as_deref(),
            Some(Expr::Lit(start)) if matches!(&start.lit, Lit::Int(n) if n.base10_digits() == "0"));
        let ends_at_owned = match range.end.as_deref() {
            Some(Expr::Path(end)) => end.path.is_ident("owned"),
            Some(Expr::MethodCall(end)) => end.method == "owned",
            _ => false,
        };
        if starts_at_0 && ends_at_owned && !self.begins_parallel {
            self.push_lone_loop(range.span().start().line);
        }
        visit::visit_expr_range(self, range);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.visit_body(call.tokens.clone());
    }
}

fn begins_parallel(name: &str) -> bool {
    name.starts_with("par_") || name.starts_with("into_par_")
}

/// What is collected is parallel no more, and neither is what a closure does for itself.
fn is_parallel(expression: &Expr) -> bool {
    let Expr::MethodCall(call) = expression else {
        return false;
    };
    let name = call.method.to_string();
    begins_parallel(&name) || (name != "collect" && is_parallel(&call.receiver))
}

/// True if it is `particles.field`, or `store.particles.field`.
fn is_field_of_particles(expression: &Expr) -> bool {
    let Expr::Field(field) = expression else {
        return false;
    };
    match &*field.base {
        Expr::Path(base) => base.path.is_ident("particles"),
        Expr::Field(base) => matches!(&base.member, Member::Named(name) if name == "particles"),
        _ => false,
    }
}

fn is_mark(tree: &TokenTree, mark: char) -> bool {
    matches!(tree, TokenTree::Punct(punct) if punct.as_char() == mark)
}

/// Drops each item behind `#[cfg(test)]`, up to its braces or semicolon, with its attributes.
fn without_unit_tests(tokens: TokenStream) -> TokenStream {
    let is_end = |tree: &TokenTree| match tree {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        tree => is_mark(tree, ';'),
    };
    let mut kept: Vec<TokenTree> = Vec::new();
    let mut rest = tokens.into_iter().peekable();
    while let Some(tree) = rest.next() {
        match tree {
            TokenTree::Group(group) if group.to_string().replace(' ', "") == "[cfg(test)]" => {
                kept.pop();
                while let [.., mark, TokenTree::Group(_)] = kept.as_slice()
                    && is_mark(mark, '#')
                {
                    kept.truncate(kept.len() - 2);
                }
                rest.find(is_end);
                // As behind `use a::{b, c};`.
                rest.next_if(|tree| is_mark(tree, ';'));
            }
            TokenTree::Group(group) => {
                let inside = without_unit_tests(group.stream());
                let mut cut = Group::new(group.delimiter(), inside);
                cut.set_span(group.span());
                kept.push(cut.into());
            }
            tree => kept.push(tree),
        }
    }
    kept.into_iter().collect()
}
