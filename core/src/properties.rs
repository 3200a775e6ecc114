//! Property tests: as `proptest`'s macro, but what tries and shrinks cases is compiled once for all of them, and not once for each.

use core::any::Any;
use core::fmt;
use std::boxed::Box;
use std::vec::{IntoIter, Vec};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{
    Config, Reason, TestCaseError, TestCaseResult, TestRunner, contextualize_config,
};

/// Tests whose arguments are drawn from strategies: `#[test] fn name(value in strategy) { ... }`, with `#![proptest_config(...)]` before them or the usual one.
macro_rules! properties {
    (@each $config:block $(
        $(#[$meta:meta])*
        fn $name:ident($($value:pat in $strategy:expr),+ $(,)?) $body:block
    )*) => {$(
        $(#[$meta])*
        fn $name() {
            let property = $crate::properties::Property {
                name: concat!(module_path!(), "::", stringify!($name)),
                file: file!(),
                values: stringify!($($value),+),
            };
            property.holds($config, ($($strategy,)+), |($($value,)+)| {
                let (): () = $body;
                Ok(())
            });
        }
    )*};
    (#![proptest_config($config:expr)] $($tests:tt)*) => {
        properties! { @each { $config } $($tests)* }
    };
    ($($tests:tt)*) => {
        properties! { @each { proptest::test_runner::Config::default() } $($tests)* }
    };
}

/// Which test it is.
pub(crate) struct Property {
    pub(crate) name: &'static str,
    pub(crate) file: &'static str,
    /// The names of what is drawn.
    pub(crate) values: &'static str,
}

/// A value that was drawn, whatever it is.
pub(crate) trait Drawn: Any + fmt::Debug {}

impl<T: Any + fmt::Debug> Drawn for T {}

type DrawnTree = Box<dyn ValueTree<Value = Box<dyn Drawn>>>;

/// A strategy, whatever its values are: several from which tests draw are one type for what puts them together, tries and shrinks.
#[derive(Debug)]
pub(crate) struct AnyStrategy(Box<dyn OfSomeValue>);

trait OfSomeValue: fmt::Debug {
    fn drawn_tree(&self, runner: &mut TestRunner) -> Result<DrawnTree, Reason>;
}

impl<S: Strategy<Tree: 'static, Value: 'static>> OfSomeValue for S {
    fn drawn_tree(&self, runner: &mut TestRunner) -> Result<DrawnTree, Reason> {
        Ok(Box::new(Tree(self.new_tree(runner)?)))
    }
}

struct Tree<T>(T);

impl<T: ValueTree<Value: 'static>> ValueTree for Tree<T> {
    type Value = Box<dyn Drawn>;

    fn current(&self) -> Self::Value {
        Box::new(self.0.current())
    }

    fn simplify(&mut self) -> bool {
        self.0.simplify()
    }

    fn complicate(&mut self) -> bool {
        self.0.complicate()
    }
}

impl Strategy for AnyStrategy {
    type Tree = DrawnTree;
    type Value = Box<dyn Drawn>;

    fn new_tree(&self, runner: &mut TestRunner) -> Result<Self::Tree, Reason> {
        self.0.drawn_tree(runner)
    }
}

/// The strategies of a test's arguments.
pub(crate) trait Strategies {
    type Values: Values;

    fn each(self) -> Vec<AnyStrategy>;
}

/// What was drawn from them.
pub(crate) trait Values: Sized {
    fn of(drawn: IntoIter<Box<dyn Drawn>>) -> Option<Self>;
}

macro_rules! strategies {
    ($($type:ident $name:ident),+) => {
        impl<$($type: Strategy<Tree: 'static, Value: 'static> + 'static),+> Strategies for ($($type,)+) {
            type Values = ($($type::Value,)+);

            fn each(self) -> Vec<AnyStrategy> {
                let ($($name,)+) = self;
                std::vec![$(AnyStrategy(Box::new($name))),+]
            }
        }

        impl<$($type: 'static),+> Values for ($($type,)+) {
            fn of(mut drawn: IntoIter<Box<dyn Drawn>>) -> Option<Self> {
                Some(($(value::<$type>(drawn.next())?,)+))
            }
        }
    };
}

strategies!(A a);
strategies!(A a, B b);
strategies!(A a, B b, C c);
strategies!(A a, B b, C c, D d);
strategies!(A a, B b, C c, D d, E e);
strategies!(A a, B b, C c, D d, E e, F f);
strategies!(A a, B b, C c, D d, E e, F f, G g);
strategies!(A a, B b, C c, D d, E e, F f, G g, H h);
strategies!(A a, B b, C c, D d, E e, F f, G g, H h, I i);

fn value<T: 'static>(drawn: Option<Box<dyn Drawn>>) -> Option<T> {
    let drawn: Box<dyn Any> = drawn?;
    drawn.downcast().ok().map(|value| *value)
}

/// Says all that was drawn as one.
struct Case {
    names: &'static str,
    values: Vec<Box<dyn Drawn>>,
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}) = (", self.names)?;
        for (at, value) in self.values.iter().enumerate() {
            let before = if at == 0 { "" } else { ", " };
            write!(f, "{before}{value:?}")?;
        }
        f.write_str(")")
    }
}

impl Property {
    /// Fails with the simplest case that was found for which `holds` does not.
    pub(crate) fn holds<S: Strategies>(
        self,
        config: Config,
        strategies: S,
        holds: impl Fn(S::Values) -> TestCaseResult,
    ) {
        self.run(config, strategies.each(), &|drawn| {
            let other = || TestCaseError::fail("a case has values of another type");
            holds(S::Values::of(drawn).ok_or_else(other)?)
        });
    }

    fn run(
        self,
        config: Config,
        strategies: Vec<AnyStrategy>,
        holds: &dyn Fn(IntoIter<Box<dyn Drawn>>) -> TestCaseResult,
    ) {
        let names = self.values;
        let cases = strategies.prop_map(move |values| Case { names, values });
        let mut config = contextualize_config(config);
        config.test_name = Some(self.name);
        config.source_file = Some(self.file);
        let mut runner = TestRunner::new(config);
        if let Err(error) = runner.run(&cases, |case| holds(case.values.into_iter())) {
            panic!("{error}\n{runner}");
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use std::panic::catch_unwind;
    use std::string::String;

    properties! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

        // Not a test by itself: it fails.
        fn every_number_is_less_than_forty_two(number in 0..1000u32, _other in 0..3u8) {
            prop_assert!(number < 42);
        }

        #[test]
        fn what_is_drawn_is_of_its_strategy(number in 5..9u32, [a, b] in [0..2u8, 3..4u8]) {
            prop_assert!((5..9).contains(&number) && a < 2 && b == 3);
        }
    }

    #[test]
    fn the_simplest_case_that_fails_is_told() {
        let told = catch_unwind(every_number_is_less_than_forty_two).expect_err("it fails");
        let told = told.downcast::<String>().expect("words");
        assert!(told.contains("(number, _other) = (42, 0)"), "{told}");
    }
}
