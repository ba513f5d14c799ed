//! References of one file within its crate: paths that begin with `crate`, `super` or `self`, in `use` lines, code and macros.

use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use std::str::FromStr;

/// The content of a file that matters for its modules.
#[derive(Debug, Default)]
pub(super) struct FileReferences {
    /// Names from below the root, and the line.
    pub paths: Vec<(Vec<String>, usize)>,
    /// The imports of `use` lines into the file's own module.
    pub imports: Vec<Import>,
    /// Items of the file's own module, macros included.
    pub items: Vec<String>,
    /// Modules in files of their own, by their names from below the root.
    pub child_files: Vec<Vec<String>>,
}

/// One name of a `use` line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Import {
    /// The name in this module; `None` for `*`.
    pub name: Option<String>,
    /// Names from below the root; `None` for another crate, or for a path that begins with a name of this module.
    pub path: Option<Vec<String>>,
    /// As it is written.
    pub written: Vec<String>,
}

/// Words that begin an item with a name.
const ITEMS: &[&str] = &[
    "fn", "struct", "enum", "union", "trait", "type", "const", "static", "mod",
];

/// Returns the references of `text`, the file of `module`, or the line that is no Rust.
pub(super) fn of_file(text: &str, module: &[String]) -> Result<FileReferences, (usize, String)> {
    let stream = TokenStream::from_str(text)
        .map_err(|error| (error.span().start().line, error.to_string()))?;
    let mut found = FileReferences::default();
    walk(stream, module, Place::Module { of_file: true }, &mut found);
    Ok(found)
}

/// The place of tokens.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Directly in a module; `of_file` unless the module has braces of its own.
    Module { of_file: bool },
    /// Deeper.
    Body,
}

fn walk(stream: TokenStream, module: &[String], place: Place, found: &mut FileReferences) {
    let tokens: Vec<TokenTree> = stream.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        if let Some((predicate, inner, length)) = attribute(&tokens[at..]) {
            at += length;
            if !is_for_tests(&predicate) {
                walk(predicate, module, Place::Body, found);
            } else if inner {
                return;
            } else {
                at += item_length(&tokens[at..]);
            }
            continue;
        }
        match &tokens[at] {
            TokenTree::Group(group) => walk(group.stream(), module, Place::Body, found),
            TokenTree::Ident(word) if *word == "use" => {
                let tree: Vec<TokenTree> = tokens[at + 1..]
                    .iter()
                    .take_while(|token| !is_punct(token, ';'))
                    .cloned()
                    .collect();
                at += tree.len();
                import(&tree, &[], module, place, found);
            }
            TokenTree::Ident(word) => {
                if place == (Place::Module { of_file: true }) {
                    note_item(word, &tokens[at + 1..], found);
                }
                if *word == "mod" && place != Place::Body {
                    at += child_module(&tokens[at + 1..], module, found);
                } else {
                    at += path(&tokens[at..], module, found);
                }
            }
            _ => {}
        }
        at += 1;
    }
}

/// Returns an attribute's contents, whether it is an inner one, and how many tokens it has.
fn attribute(tokens: &[TokenTree]) -> Option<(TokenStream, bool, usize)> {
    let hash = tokens.first().is_some_and(|token| is_punct(token, '#'));
    let inner = tokens.get(1).is_some_and(|token| is_punct(token, '!'));
    match tokens.get(1 + usize::from(inner)) {
        Some(TokenTree::Group(group)) if hash && group.delimiter() == Delimiter::Bracket => {
            Some((group.stream(), inner, 2 + usize::from(inner)))
        }
        _ => None,
    }
}

/// Returns whether an attribute keeps what it stands at out of everything but tests.
fn is_for_tests(attribute: &TokenStream) -> bool {
    let tokens: Vec<TokenTree> = attribute.clone().into_iter().collect();
    match &tokens[..] {
        [TokenTree::Ident(word)] => *word == "test",
        [TokenTree::Ident(word), TokenTree::Group(group)] => {
            *word == "cfg" && needs_test(group.stream())
        }
        _ => false,
    }
}

/// Returns whether a predicate such as `test` or `all(test, unix)` holds in tests alone.
fn needs_test(predicate: TokenStream) -> bool {
    let tokens: Vec<TokenTree> = predicate.into_iter().collect();
    match &tokens[..] {
        [TokenTree::Ident(word)] => *word == "test",
        [TokenTree::Ident(word), TokenTree::Group(group)] if *word == "all" => {
            let parts: Vec<TokenTree> = group.stream().into_iter().collect();
            let mut parts = parts.split(|token| is_punct(token, ','));
            parts.any(|part| needs_test(part.iter().cloned().collect()))
        }
        _ => false,
    }
}

/// Returns how many tokens the item at the start has, further attributes included: up to a semicolon or braces, and for fields
/// and arms, which no word like `fn` begins, up to a comma.
fn item_length(tokens: &[TokenTree]) -> usize {
    let mut is_item = false;
    for (k, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(word) => {
                let word = word.to_string();
                is_item |= word == "impl" || word == "use" || ITEMS.contains(&word.as_str());
            }
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => return k + 1,
            token if is_punct(token, ';') || (!is_item && is_punct(token, ',')) => return k + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// Notes the item that `word` begins, and macros.
fn note_item(word: &Ident, rest: &[TokenTree], found: &mut FileReferences) {
    let name = match rest {
        [TokenTree::Punct(mark), TokenTree::Ident(name), ..]
            if *word == "macro_rules" && mark.as_char() == '!' =>
        {
            name
        }
        [TokenTree::Ident(name), ..] if ITEMS.contains(&word.to_string().as_str()) => name,
        _ => return,
    };
    found.items.push(name.to_string());
}

/// Notes what comes after `mod`, and returns how many tokens that is.
fn child_module(rest: &[TokenTree], module: &[String], found: &mut FileReferences) -> usize {
    let Some(TokenTree::Ident(name)) = rest.first() else {
        return 0;
    };
    let mut child = module.to_vec();
    child.push(name.to_string());
    match rest.get(1) {
        Some(TokenTree::Group(group)) => {
            walk(
                group.stream(),
                &child,
                Place::Module { of_file: false },
                found,
            );
        }
        _ => found.child_files.push(child),
    }
    2
}

/// Notes the path at the start, if it stays in the crate, and returns how many tokens come after its first.
fn path(tokens: &[TokenTree], module: &[String], found: &mut FileReferences) -> usize {
    let mut names = Vec::new();
    let mut length = 0;
    while let Some(TokenTree::Ident(name)) = tokens.get(length) {
        names.push(name.to_string());
        length += 1;
        if !is_path_separator(&tokens[length..]) {
            break;
        }
        length += 2;
    }
    if names.len() > 1
        && let Some(path) = from_root(&names, module)
    {
        found.paths.push((path, line(&tokens[0])));
    }
    length.saturating_sub(1)
}

/// Notes each name of a `use` tree, below the names of `before`.
fn import(
    tree: &[TokenTree],
    before: &[String],
    module: &[String],
    place: Place,
    found: &mut FileReferences,
) {
    let mut written = before.to_vec();
    let mut name = None;
    let mut at = 0;
    while let Some(token) = tree.get(at) {
        match token {
            TokenTree::Ident(word) if *word == "as" => {
                name = tree.get(at + 1).map(ToString::to_string);
                break;
            }
            TokenTree::Ident(word) => {
                // `a::{self}` is `a`.
                if *word != "self" || written.is_empty() {
                    written.push(word.to_string());
                }
                name = written.last().cloned();
            }
            TokenTree::Group(group) => {
                let parts: Vec<TokenTree> = group.stream().into_iter().collect();
                for part in parts.split(|token| is_punct(token, ',')) {
                    if !part.is_empty() {
                        import(part, &written, module, place, found);
                    }
                }
                return;
            }
            token if is_punct(token, '*') => name = None,
            _ => {}
        }
        at += 1;
    }
    let path = from_root(&written, module);
    if let (Some(path), Some(first)) = (&path, tree.first()) {
        found.paths.push((path.clone(), line(first)));
    }
    if place == (Place::Module { of_file: true }) {
        found.imports.push(Import {
            name,
            path,
            written,
        });
    }
}

/// Returns the names from below the root of a path in `module`, or nothing for one that begins with another name.
fn from_root(names: &[String], module: &[String]) -> Option<Vec<String>> {
    let mut base = match names.first()?.as_str() {
        "crate" => Vec::new(),
        "self" => module.to_vec(),
        "super" => module.split_last()?.1.to_vec(),
        _ => return None,
    };
    let mut rest = &names[1..];
    while rest.first().is_some_and(|name| name == "super") {
        base.pop();
        rest = &rest[1..];
    }
    base.extend_from_slice(rest);
    Some(base)
}

fn is_punct(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
}

fn is_path_separator(tokens: &[TokenTree]) -> bool {
    tokens.len() > 1 && is_punct(&tokens[0], ':') && is_punct(&tokens[1], ':')
}

fn line(token: &TokenTree) -> usize {
    token.span().start().line
}
