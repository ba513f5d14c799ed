//! Sentences of several clauses or forms.

use super::from_tree::clause;
use super::questions::{indirect_question, question};
use super::requests::plan;
use super::to_tree::TreeBuilder;
use crate::form::{Clause, Form, Question};
use crate::grammar::Tree;

/// The two forms in the tree of one sentence; `None` for other trees.
pub(super) fn forms(function: &str, first: &Tree, second: &Tree) -> Option<Vec<Form>> {
    Some(match function {
        "request_ask" => vec![
            Form::Request(plan(first)?),
            Form::Question(indirect_question(second)?),
        ],
        "request_question" => vec![
            Form::Request(plan(first)?),
            Form::Question(question(second)?),
        ],
        "several_questions" => vec![
            Form::Question(question(first)?),
            Form::Question(question(second)?),
        ],
        "claim_request" => vec![Form::Claim(clause(first)?), Form::Request(plan(second)?)],
        "request_claim" => vec![Form::Request(plan(first)?), Form::Claim(clause(second)?)],
        "claim_question" => vec![
            Form::Claim(clause(first)?),
            Form::Question(question(second)?),
        ],
        _ => return None,
    })
}

impl TreeBuilder<'_> {
    pub(super) fn form_pair(&self, forms: &[Form]) -> Option<Tree> {
        match forms {
            [Form::Question(first), Form::Question(second)] => Some(Tree::apply(
                "several_questions",
                [self.question(first)?, self.question(second)?],
            )),
            [
                Form::Request(steps),
                Form::Question(Question::Whether(clause)),
            ] => {
                let whether = Tree::apply("indirect_whether", [self.simple_clause(clause)?]);
                Some(Tree::apply("request_ask", [self.plan(steps)?, whether]))
            }
            [Form::Request(steps), Form::Question(asked)] => Some(Tree::apply(
                "request_question",
                [self.plan(steps)?, self.question(asked)?],
            )),
            [Form::Claim(said), Form::Request(steps)] => Some(Tree::apply(
                "claim_request",
                [self.clause(said)?, self.plan(steps)?],
            )),
            [Form::Request(steps), Form::Claim(said)] => Some(Tree::apply(
                "request_claim",
                [self.plan(steps)?, self.clause(said)?],
            )),
            [Form::Claim(said), Form::Question(asked)] => Some(Tree::apply(
                "claim_question",
                [self.clause(said)?, self.question(asked)?],
            )),
            _ => None,
        }
    }

    pub(super) fn clause(&self, clause: &Clause) -> Option<Tree> {
        Some(match clause {
            Clause::All(clauses) => {
                Tree::apply("all_clauses", [self.list(clauses, "and_pair", "and_more")?])
            }
            Clause::Any(clauses) => {
                Tree::apply("any_clause", [self.list(clauses, "or_pair", "or_more")?])
            }
            Clause::Now(inner) => {
                let function = match **inner {
                    Clause::Not(_) => "no_longer",
                    _ => "now",
                };
                Tree::apply(function, [self.simple_clause(inner)?])
            }
            _ => Tree::apply("one_clause", [self.simple_clause(clause)?]),
        })
    }

    fn list(&self, clauses: &[Clause], pair: &str, more: &str) -> Option<Tree> {
        match clauses {
            [first, last] => Some(Tree::apply(
                pair,
                [self.simple_clause(first)?, self.simple_clause(last)?],
            )),
            [first, rest @ ..] if rest.len() > 1 => Some(Tree::apply(
                more,
                [self.simple_clause(first)?, self.list(rest, pair, more)?],
            )),
            _ => None,
        }
    }
}
