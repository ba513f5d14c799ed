//! Sentences of several clauses or forms.

use super::to_tree::TreeBuilder;
use crate::form::{Clause, Form, Question};
use crate::grammar::Tree;

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
