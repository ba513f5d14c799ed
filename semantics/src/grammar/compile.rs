//! Rules as a context-free grammar: one production for each wording and each choice of variants.

use super::GrammarError;
use super::file::{GrammarFile, RuleFile};
use super::left_corner::LeftCorners;
use super::template::{TemplateElement, VariantPattern, category, read};
use std::collections::{BTreeMap, BTreeSet};

/// A category with a variant, such as `np.several`.
pub(super) type NonTerminal = usize;

/// A symbol on the right-hand side of a production.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Symbol {
    Word(String),
    /// An argument: its number, counted from 0, and its kind.
    Argument(usize, ArgumentKind),
}

/// The kind of text that an argument becomes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ArgumentKind {
    /// A phrase of a category, made by rules.
    Rules(NonTerminal),
    /// An entry of a class of the lexicon, in a variant.
    Entry(String, usize),
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
    pub(super) function: String,
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
    /// Productions by function and the non-terminal of their result.
    pub(super) of_function: BTreeMap<String, BTreeMap<NonTerminal, Vec<usize>>>,
    pub(super) numbers: BTreeMap<(String, usize), NonTerminal>,
    pub(super) left_corners: LeftCorners,
}

pub(super) const COUNT: &str = "count";
pub(super) const ORDINAL: &str = "ordinal";
pub(super) const DIGITS: &str = "digits";

struct Compiler<'a> {
    file: &'a GrammarFile,
    /// The categories that rules make; all others are classes of the lexicon.
    made: BTreeSet<&'a str>,
    found: Productions,
}

/// The variants of a category that has one.
static ONE_VARIANT: [String; 1] = [String::new()];

impl<'a> Compiler<'a> {
    fn variants(&self, category: &str) -> &'a [String] {
        let own = self.file.variants.get(category);
        own.map_or(&ONE_VARIANT, Vec::as_slice)
    }

    fn intern_non_terminal(&mut self, category: &str, variant: usize) -> NonTerminal {
        let next = self.found.numbers.len();
        let key = (category.to_owned(), variant);
        let number = *self.found.numbers.entry(key).or_insert(next);
        if number == next {
            self.found.of_result.push(Vec::new());
        }
        number
    }

    /// The assignments of variants to the variables of a wording.
    fn choices(
        &self,
        rule: &'a RuleFile,
        pieces: &[TemplateElement<'a>],
        result: (&'a str, VariantPattern<'a>),
    ) -> Result<Vec<Choice<'a>>, GrammarError> {
        let mut choices: Vec<Choice<'a>> = vec![Vec::new()];
        let mut places = vec![(Variable::of(result.1, usize::MAX), result.0)];
        for (k, piece) in pieces.iter().enumerate() {
            if let TemplateElement::Argument(at, variant) = piece {
                places.push((Variable::of(*variant, k), &rule.arguments[*at]));
            }
        }
        for (variable, category) in places {
            let variants = self.variants(category);
            if matches!(variable, Variable::Named(name) if variants.iter().any(|one| one == name)) {
                continue;
            }
            let mut next = Vec::new();
            for choice in choices {
                match chosen(&choice, variable) {
                    Some(chosen) if variants.iter().any(|one| one == chosen) => next.push(choice),
                    Some(_) => {}
                    None => next.extend(variants.iter().map(|variant| {
                        let mut more = choice.clone();
                        more.push((variable, variant));
                        more
                    })),
                }
            }
            choices = next;
        }
        if choices.is_empty() {
            let known = self.variants(result.0).to_vec();
            return Err(unknown(rule, "common variant of", &rule.result, known));
        }
        Ok(choices)
    }

    fn variant_of(
        &self,
        rule: &RuleFile,
        category: &str,
        variable: Variable<'a>,
        choice: &Choice<'a>,
    ) -> Result<usize, GrammarError> {
        let name = value(variable, choice);
        let variants = self.variants(category);
        let at = variants.iter().position(|known| known == name);
        at.ok_or_else(|| unknown(rule, "variant", name, variants.to_vec()))
    }

    fn symbol(
        &mut self,
        rule: &'a RuleFile,
        (k, piece): (usize, &TemplateElement<'a>),
        choice: &Choice<'a>,
    ) -> Result<Symbol, GrammarError> {
        Ok(match piece {
            TemplateElement::Word(word) => Symbol::Word(word.clone()),
            TemplateElement::Inflected(name, variant) => {
                let Some(forms) = self.file.words.get(*name) else {
                    let known = self.file.words.keys().cloned().collect();
                    return Err(unknown(rule, "word", name, known));
                };
                let variant = value(Variable::of(*variant, k), choice);
                let word = forms.get(variant).ok_or_else(|| {
                    let known = forms.keys().cloned().collect();
                    unknown(rule, "variant", variant, known)
                })?;
                Symbol::Word(word.to_lowercase())
            }
            TemplateElement::Argument(at, variant) => {
                let category = rule.arguments[*at].as_str();
                let variant = self.variant_of(rule, category, Variable::of(*variant, k), choice)?;
                let kind = match category {
                    COUNT => ArgumentKind::Count,
                    ORDINAL => ArgumentKind::Ordinal,
                    DIGITS => ArgumentKind::Digits,
                    made if self.made.contains(made) => {
                        ArgumentKind::Rules(self.intern_non_terminal(category, variant))
                    }
                    _ => ArgumentKind::Entry(category.to_owned(), variant),
                };
                Symbol::Argument(*at, kind)
            }
        })
    }

    fn add(
        &mut self,
        rule: &'a RuleFile,
        text: &'a str,
        wording: Option<usize>,
    ) -> Result<(), GrammarError> {
        let pieces = read(text, rule.arguments.len())?;
        for argument in 0..rule.arguments.len() {
            let said = |piece: &TemplateElement<'_>| matches!(piece, TemplateElement::Argument(at, _) if *at == argument);
            if !pieces.iter().any(said) {
                return Err(GrammarError::LeftOut {
                    rule: rule.function.clone(),
                    template: text.to_owned(),
                    argument: argument + 1,
                });
            }
        }
        let result = category(&rule.result);
        for choice in self.choices(rule, &pieces, result)? {
            let variable = Variable::of(result.1, usize::MAX);
            let variant = self.variant_of(rule, result.0, variable, &choice)?;
            let number = self.intern_non_terminal(result.0, variant);
            let symbols = pieces.iter().enumerate();
            let symbols: Result<Vec<Symbol>, GrammarError> = symbols
                .map(|piece| self.symbol(rule, piece, &choice))
                .collect();
            let at = self.found.all.len();
            self.found.all.push(Production {
                function: rule.function.clone(),
                arity: rule.arguments.len(),
                result: number,
                symbols: symbols?,
                wording,
                cost: rule.cost + u32::from(wording.is_none()),
            });
            self.found.of_result[number].push(at);
            let own = self
                .found
                .of_function
                .entry(rule.function.clone())
                .or_default();
            own.entry(number).or_default().push(at);
        }
        Ok(())
    }
}

/// What stands for a variant in a wording: a name, which is a variant or a variable, or any variant of the piece of this number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Variable<'a> {
    Named(&'a str),
    AnyOf(usize),
}

impl<'a> Variable<'a> {
    fn of(variant: VariantPattern<'a>, piece: usize) -> Self {
        match variant {
            VariantPattern::Any => Self::AnyOf(piece),
            VariantPattern::Named(name) => Self::Named(name),
        }
    }
}

/// The variants that the variables of a wording have.
type Choice<'a> = Vec<(Variable<'a>, &'a str)>;

fn chosen<'a>(choice: &Choice<'a>, variable: Variable<'a>) -> Option<&'a str> {
    let own = choice.iter().find(|(known, _)| *known == variable);
    own.map(|(_, variant)| *variant)
}

/// The variant that a variable has, or that it names.
fn value<'a>(variable: Variable<'a>, choice: &Choice<'a>) -> &'a str {
    chosen(choice, variable).unwrap_or(match variable {
        Variable::Named(name) => name,
        Variable::AnyOf(_) => "",
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
    let mut signatures: BTreeMap<&str, (&[String], &str)> = BTreeMap::new();
    for rule in &file.rule {
        let own = (rule.arguments.as_slice(), category(&rule.result).0);
        let known = signatures.entry(&rule.function).or_insert(own);
        if *known != own {
            return Err(GrammarError::Signature {
                rule: rule.function.clone(),
            });
        }
    }
    let made = file.rule.iter().map(|rule| category(&rule.result).0);
    let mut compiler = Compiler {
        file,
        made: made.collect(),
        found: Productions::default(),
    };
    // The number of wordings that each function has so far.
    let mut wordings: BTreeMap<&str, usize> = BTreeMap::new();
    for rule in &file.rule {
        let wordings = wordings.entry(&rule.function).or_insert(0_usize);
        for text in &rule.texts {
            compiler.add(rule, text, Some(*wordings))?;
            *wordings += 1;
        }
        for text in &rule.reads {
            compiler.add(rule, text, None)?;
        }
    }
    let mut found = compiler.found;
    check_no_cycles(&found)?;
    found.left_corners = LeftCorners::gather(&found.all, found.of_result.len());
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
    for (key, start) in &found.numbers {
        let mut seen = BTreeSet::new();
        let mut open: Vec<NonTerminal> = single(*start).collect();
        while let Some(number) = open.pop() {
            if number == *start {
                return Err(GrammarError::Circle {
                    category: key.0.clone(),
                });
            }
            if seen.insert(number) {
                open.extend(single(number));
            }
        }
    }
    Ok(())
}
