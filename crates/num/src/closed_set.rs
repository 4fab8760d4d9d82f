//! Enums that are closed sets: one row for each variant, from which the list of all and their names follow.

/// Declares an enum with `ALL`, its variants in their order, and, where each row has a name, the function `name`. Rows
/// may have one more text, whose function is named below them.
///
/// ```
/// fosssim_num::closed_set! {
///     /// A side of a half-plane.
///     #[derive(Debug, PartialEq)]
///     pub enum Side {
///         /// Where its normal points.
///         Front = "in front",
///         /// The other one.
///         Back = "behind",
///     }
/// }
/// assert_eq!(Side::ALL.map(Side::name), ["in front", "behind"]);
/// ```
#[macro_export]
macro_rules! closed_set {
    ($(#[$meta:meta])* $vis:vis enum $set:ident { $($(#[$about:meta])* $variant:ident,)+ }) => {
        $(#[$meta])*
        $vis enum $set { $($(#[$about])* $variant,)+ }

        impl $set {
            /// All variants, in their order.
            $vis const ALL: [Self; [$(Self::$variant),+].len()] = [$(Self::$variant),+];
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $set:ident { $($(#[$about:meta])* $variant:ident = $name:literal,)+ }) => {
        $crate::closed_set! { $(#[$meta])* $vis enum $set { $($(#[$about])* $variant,)+ } }

        impl $set {
            /// Returns the name for people, files and command lines.
            #[must_use]
            $vis const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $set:ident {
        $($(#[$about:meta])* $variant:ident = $name:literal, $more:literal;)+
    } $(#[$of_more:meta])* $second:ident) => {
        $crate::closed_set! { $(#[$meta])* $vis enum $set { $($(#[$about])* $variant = $name,)+ } }

        impl $set {
            $(#[$of_more])*
            #[must_use]
            $vis const fn $second(self) -> &'static str {
                match self { $(Self::$variant => $more,)+ }
            }
        }
    };
}
