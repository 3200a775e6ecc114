//! Property tests: as `proptest`'s macro, but what tries and shrinks cases is compiled once for all of them, and not once for each.

use core::any::Any;
use core::fmt;
use std::boxed::Box;

use proptest::strategy::{BoxedStrategy, Strategy};
use proptest::test_runner::{
    Config, TestCaseError, TestCaseResult, TestRunner, contextualize_config,
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

/// What was drawn, whatever it is.
trait Values: Any + fmt::Debug {}

impl<T: Any + fmt::Debug> Values for T {}

struct Case {
    names: &'static str,
    values: Box<dyn Values>,
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}) = {:?}", self.names, self.values)
    }
}

impl Property {
    /// Fails with the simplest case that was found for which `holds` does not.
    pub(crate) fn holds<S>(
        self,
        config: Config,
        strategy: S,
        holds: impl Fn(S::Value) -> TestCaseResult,
    ) where
        S: Strategy + 'static,
        S::Value: 'static,
    {
        let names = self.values;
        let cases = strategy.prop_map(move |values| Case {
            names,
            values: Box::new(values),
        });
        self.run(config, &cases.boxed(), &|case| {
            let values: Box<dyn Any> = case.values;
            let other = |_| TestCaseError::fail("a case has values of another type");
            holds(*values.downcast().map_err(other)?)
        });
    }

    fn run(
        self,
        config: Config,
        cases: &BoxedStrategy<Case>,
        holds: &dyn Fn(Case) -> TestCaseResult,
    ) {
        let mut config = contextualize_config(config);
        config.test_name = Some(self.name);
        config.source_file = Some(self.file);
        let mut runner = TestRunner::new(config);
        if let Err(error) = runner.run(cases, holds) {
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
