//! Rules as a context-free grammar: one production for each wording and each choice of variants.

use super::GrammarError;
use super::file::{GrammarFile, RuleFile};
use super::left_corner::LeftCorners;
use super::name_table::NameTable;
use super::template::{TemplateElement, VariantPattern, category, read};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// A category with a variant, such as `np.several`.
pub(super) type NonTerminal = usize;

/// A symbol on the right-hand side of a production.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Symbol {
    /// A word, by its number in [`Productions::words`].
    Word(usize),
    /// An argument: its number, counted from 0, and its kind.
    Argument(usize, ArgumentKind),
}

/// The kind of text that an argument becomes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ArgumentKind {
    /// A phrase of a category, made by rules.
    Rules(NonTerminal),
    /// An entry of a class of the lexicon, in a variant.
    Entry(Arc<str>, usize),
    /// A whole number.
    Count,
    /// A place in an order.
    Ordinal,
    /// A number that names something: digits.
    Digits,
}

/// A wording of a rule for one choice of variants.
#[derive(Clone, Debug)]
pub(super) struct Production {
    /// The function, by its number in [`Productions::functions`].
    pub(super) function: usize,
    pub(super) arity: usize,
    pub(super) result: NonTerminal,
    pub(super) symbols: Vec<Symbol>,
    /// Index among the function's wordings that are said; `None` for a wording that is only read.
    pub(super) wording: Option<usize>,
    /// Cost of a reading that uses it; readings of less cost are preferred.
    pub(super) cost: u32,
}

/// The productions with their categories.
#[derive(Clone, Debug, Default)]
pub(super) struct Productions {
    pub(super) all: Vec<Production>,
    /// Productions by the non-terminal of their result.
    pub(super) of_result: Vec<Vec<usize>>,
    /// The names of functions.
    pub(super) functions: NameTable,
    /// Productions by function and the non-terminal of their result.
    pub(super) of_function: Vec<BTreeMap<NonTerminal, Vec<usize>>>,
    /// The words that occur in rules.
    pub(super) words: NameTable,
    /// The non-terminals of each category that rules make, by its variants.
    pub(super) of_category: BTreeMap<String, Vec<NonTerminal>>,
    pub(super) left_corners: LeftCorners,
}

impl Productions {
    /// The productions of a function by the non-terminal of their result; `None` for an unknown function.
    pub(super) fn of_function(&self, name: &str) -> Option<&BTreeMap<NonTerminal, Vec<usize>>> {
        Some(&self.of_function[self.functions.find(name)?])
    }
}

pub(super) const COUNT: &str = "count";
pub(super) const ORDINAL: &str = "ordinal";
pub(super) const DIGITS: &str = "digits";

/// The number of the empty name, that of the variant of a category that has one.
const NO_VARIANT: usize = 0;

/// A category or a class of the lexicon.
struct Category<'a> {
    name: &'a str,
    /// The numbers of its variants' names.
    variants: Vec<usize>,
    kind: CategoryKind,
}

enum CategoryKind {
    /// Made by rules: its non-terminals by variant, as far as they occur.
    Made(Vec<Option<NonTerminal>>),
    Class(Arc<str>),
    Count,
    Ordinal,
    Digits,
}

/// A rule with its categories by their numbers.
struct Signature<'a> {
    rule: &'a RuleFile,
    function: usize,
    /// The variant and the category.
    result: (Variable, usize),
    arguments: Vec<usize>,
}

/// An element of a wording.
enum Piece<'a> {
    /// A word, by its number.
    Word(usize),
    /// A word in a variant: its forms.
    Inflected(&'a BTreeMap<String, String>, Variable),
    /// An argument, its category and its variant.
    Argument(usize, usize, Variable),
}

struct Compiler<'a> {
    file: &'a GrammarFile,
    categories: Vec<Category<'a>>,
    /// The numbers of categories by their names.
    numbers: HashMap<&'a str, usize>,
    /// The names of variants and of variables over them.
    variants: NameTable,
    found: Productions,
}

impl<'a> Compiler<'a> {
    fn new(file: &'a GrammarFile) -> Self {
        let made = file.rule.iter().map(|rule| category(&rule.result).0);
        let mut compiler = Self {
            file,
            categories: Vec::new(),
            numbers: HashMap::new(),
            variants: NameTable::default(),
            found: Productions::default(),
        };
        // The first name is that of NO_VARIANT.
        compiler.variants.intern("");
        for name in made {
            compiler.intern_category(name, true);
        }
        compiler
    }

    fn intern_category(&mut self, name: &'a str, is_made: bool) -> usize {
        if let Some(known) = self.numbers.get(name) {
            return *known;
        }
        let variants = match self.file.variants.get(name) {
            Some(own) => own.iter().map(|one| self.variants.intern(one)).collect(),
            None => vec![NO_VARIANT],
        };
        let kind = match name {
            COUNT => CategoryKind::Count,
            ORDINAL => CategoryKind::Ordinal,
            DIGITS => CategoryKind::Digits,
            _ if is_made => CategoryKind::Made(vec![None; variants.len()]),
            _ => CategoryKind::Class(name.into()),
        };
        self.categories.push(Category {
            name,
            variants,
            kind,
        });
        self.numbers.insert(name, self.categories.len() - 1);
        self.categories.len() - 1
    }

    fn signature(&mut self, rule: &'a RuleFile) -> Signature<'a> {
        let (result, variant) = category(&rule.result);
        let function = self.found.functions.intern(&rule.function);
        if function == self.found.of_function.len() {
            self.found.of_function.push(BTreeMap::new());
        }
        let arguments = rule.arguments.iter();
        Signature {
            rule,
            function,
            result: (
                self.variable(variant, usize::MAX),
                self.intern_category(result, true),
            ),
            arguments: arguments
                .map(|name| self.intern_category(name, false))
                .collect(),
        }
    }

    fn argument_kind(&mut self, category: usize, variant: usize) -> ArgumentKind {
        match &mut self.categories[category].kind {
            CategoryKind::Count => ArgumentKind::Count,
            CategoryKind::Ordinal => ArgumentKind::Ordinal,
            CategoryKind::Digits => ArgumentKind::Digits,
            CategoryKind::Class(name) => ArgumentKind::Entry(name.clone(), variant),
            CategoryKind::Made(own) => {
                let of_result = &mut self.found.of_result;
                ArgumentKind::Rules(*own[variant].get_or_insert_with(|| {
                    of_result.push(Vec::new());
                    of_result.len() - 1
                }))
            }
        }
    }

    /// A pattern of a variant as a variable; `place` tells it from other patterns of any variant.
    fn variable(&mut self, pattern: VariantPattern<'a>, place: usize) -> Variable {
        match pattern {
            VariantPattern::Any => Variable::AnyOf(place),
            VariantPattern::Named(name) => Variable::Named(self.variants.intern(name)),
        }
    }

    /// Reads a wording of a rule.
    fn pieces(
        &mut self,
        signature: &Signature<'a>,
        text: &'a str,
    ) -> Result<Vec<Piece<'a>>, GrammarError> {
        let rule = signature.rule;
        let mut pieces = Vec::new();
        for (k, piece) in read(text, rule.arguments.len())?.into_iter().enumerate() {
            pieces.push(match piece {
                TemplateElement::Word(word) => Piece::Word(self.found.words.intern(&word)),
                TemplateElement::Inflected(name, variant) => {
                    let Some(forms) = self.file.words.get(name) else {
                        let known = self.file.words.keys().cloned().collect();
                        return Err(unknown(rule, "word", name, known));
                    };
                    Piece::Inflected(forms, self.variable(variant, k))
                }
                TemplateElement::Argument(at, variant) => {
                    Piece::Argument(at, signature.arguments[at], self.variable(variant, k))
                }
            });
        }
        for argument in 0..rule.arguments.len() {
            let said =
                |piece: &Piece<'_>| matches!(piece, Piece::Argument(at, ..) if *at == argument);
            if !pieces.iter().any(said) {
                return Err(GrammarError::LeftOut {
                    rule: rule.function.clone(),
                    template: text.to_owned(),
                    argument: argument + 1,
                });
            }
        }
        Ok(pieces)
    }

    /// The assignments of variants to the variables of a wording.
    fn choices(
        &self,
        signature: &Signature<'a>,
        pieces: &[Piece<'a>],
    ) -> Result<Vec<Choice>, GrammarError> {
        let mut choices: Vec<Choice> = vec![Vec::new()];
        let arguments = pieces.iter().filter_map(|piece| match piece {
            Piece::Argument(_, category, variable) => Some((*variable, *category)),
            _ => None,
        });
        for (variable, category) in std::iter::once(signature.result).chain(arguments) {
            let variants = &self.categories[category].variants;
            if matches!(variable, Variable::Named(name) if variants.contains(&name)) {
                continue;
            }
            let mut next = Vec::new();
            for choice in choices {
                match chosen(&choice, variable) {
                    Some(chosen) if variants.contains(&chosen) => next.push(choice),
                    Some(_) => {}
                    None => next.extend(variants.iter().map(|variant| {
                        let mut more = choice.clone();
                        more.push((variable, *variant));
                        more
                    })),
                }
            }
            choices = next;
        }
        if choices.is_empty() {
            let known = self.variant_names(signature.result.1);
            let rule = signature.rule;
            return Err(unknown(rule, "common variant of", &rule.result, known));
        }
        Ok(choices)
    }

    fn variant_names(&self, category: usize) -> Vec<String> {
        let variants = self.categories[category].variants.iter();
        variants
            .map(|variant| self.variants.name(*variant).to_owned())
            .collect()
    }

    fn variant_of(
        &self,
        rule: &RuleFile,
        (variable, category): (Variable, usize),
        choice: &Choice,
    ) -> Result<usize, GrammarError> {
        let name = value(variable, choice);
        let variants = &self.categories[category].variants;
        let at = variants.iter().position(|known| *known == name);
        at.ok_or_else(|| {
            let known = self.variant_names(category);
            unknown(rule, "variant", self.variants.name(name), known)
        })
    }

    fn symbol(
        &mut self,
        rule: &RuleFile,
        piece: &Piece<'a>,
        choice: &Choice,
    ) -> Result<Symbol, GrammarError> {
        Ok(match piece {
            Piece::Word(word) => Symbol::Word(*word),
            Piece::Inflected(forms, variable) => {
                let variant = self.variants.name(value(*variable, choice));
                let word = forms.get(variant).ok_or_else(|| {
                    let known = forms.keys().cloned().collect();
                    unknown(rule, "variant", variant, known)
                })?;
                Symbol::Word(self.found.words.intern(&word.to_lowercase()))
            }
            Piece::Argument(at, category, variable) => {
                let variant = self.variant_of(rule, (*variable, *category), choice)?;
                Symbol::Argument(*at, self.argument_kind(*category, variant))
            }
        })
    }

    fn add(
        &mut self,
        signature: &Signature<'a>,
        text: &'a str,
        wording: Option<usize>,
    ) -> Result<(), GrammarError> {
        let rule = signature.rule;
        let pieces = self.pieces(signature, text)?;
        let (_, category) = signature.result;
        for choice in self.choices(signature, &pieces)? {
            let variant = self.variant_of(rule, signature.result, &choice)?;
            let ArgumentKind::Rules(result) = self.argument_kind(category, variant) else {
                let name = self.categories[category].name;
                return Err(unknown(rule, "category of phrases", name, Vec::new()));
            };
            let mut symbols = Vec::with_capacity(pieces.len());
            for piece in &pieces {
                symbols.push(self.symbol(rule, piece, &choice)?);
            }
            let at = self.found.all.len();
            self.found.all.push(Production {
                function: signature.function,
                arity: rule.arguments.len(),
                result,
                symbols,
                wording,
                cost: rule.cost + u32::from(wording.is_none()),
            });
            self.found.of_result[result].push(at);
            let own = &mut self.found.of_function[signature.function];
            own.entry(result).or_default().push(at);
        }
        Ok(())
    }

    /// The productions, once all rules are added.
    fn finish(self) -> Productions {
        let mut found = self.found;
        for category in self.categories {
            if let CategoryKind::Made(own) = category.kind {
                let own = own.into_iter().flatten().collect();
                found.of_category.insert(category.name.to_owned(), own);
            }
        }
        found
    }
}

/// What stands for a variant in a wording: a name, which is a variant or a variable, or any variant of the piece of this number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Variable {
    Named(usize),
    AnyOf(usize),
}

/// The variants that the variables of a wording have.
type Choice = Vec<(Variable, usize)>;

fn chosen(choice: &Choice, variable: Variable) -> Option<usize> {
    let own = choice.iter().find(|(known, _)| *known == variable);
    own.map(|(_, variant)| *variant)
}

/// The variant that a variable has, or that it names.
fn value(variable: Variable, choice: &Choice) -> usize {
    chosen(choice, variable).unwrap_or(match variable {
        Variable::Named(name) => name,
        Variable::AnyOf(_) => NO_VARIANT,
    })
}

fn unknown(rule: &RuleFile, kind: &'static str, name: &str, known: Vec<String>) -> GrammarError {
    GrammarError::Unknown {
        rule: rule.function.clone(),
        kind,
        name: name.to_owned(),
        known,
    }
}

/// Compiles a grammar file to productions.
///
/// # Errors
/// [`GrammarError`] names the rule and what is wrong in it.
pub(super) fn compile(file: &GrammarFile) -> Result<Productions, GrammarError> {
    let mut signatures: HashMap<&str, (&[String], &str)> = HashMap::new();
    for rule in &file.rule {
        let own = (rule.arguments.as_slice(), category(&rule.result).0);
        let known = signatures.entry(&rule.function).or_insert(own);
        if *known != own {
            return Err(GrammarError::Signature {
                rule: rule.function.clone(),
            });
        }
    }
    let mut compiler = Compiler::new(file);
    // The number of wordings that each function has so far.
    let mut wordings: Vec<usize> = Vec::new();
    for rule in &file.rule {
        let signature = compiler.signature(rule);
        wordings.resize(compiler.found.of_function.len(), 0);
        let wordings = &mut wordings[signature.function];
        for text in &rule.texts {
            compiler.add(&signature, text, Some(*wordings))?;
            *wordings += 1;
        }
        for text in &rule.reads {
            compiler.add(&signature, text, None)?;
        }
    }
    let mut found = compiler.finish();
    check_no_cycles(&found)?;
    found.left_corners = LeftCorners::gather(&found.all, found.of_result.len(), found.words.len());
    Ok(found)
}

/// Checks that there is no cycle of unit productions (one argument and nothing else): a text would have infinitely many parses.
fn check_no_cycles(found: &Productions) -> Result<(), GrammarError> {
    let single = |number: NonTerminal| {
        let own = found.of_result[number].iter().map(|at| &found.all[*at]);
        own.filter_map(|one| match one.symbols[..] {
            [Symbol::Argument(_, ArgumentKind::Rules(next))] => Some(next),
            _ => None,
        })
    };
    let all = found.of_category.iter();
    for (name, start) in all.flat_map(|(name, own)| own.iter().map(move |one| (name, one))) {
        let mut seen = BTreeSet::new();
        let mut open: Vec<NonTerminal> = single(*start).collect();
        while let Some(number) = open.pop() {
            if number == *start {
                return Err(GrammarError::Circle {
                    category: name.clone(),
                });
            }
            if seen.insert(number) {
                open.extend(single(number));
            }
        }
    }
    Ok(())
}
