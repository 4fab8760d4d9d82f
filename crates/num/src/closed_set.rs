//! Enums that are closed sets, declared with one row per variant, with a list of all variants and their names.

/// Declares an enum with `ALL`, its variants in order, and, if each row has a name, the function `name`. Rows may have
/// a second text. Its function is named below the rows.
///
/// ```
/// fosssim_num::closed_set! {
///     /// A side of a half-plane.
///     #[derive(Debug, PartialEq)]
///     pub enum Side {
///         /// The side to which the normal points.
///         Front = "in front",
///         /// The opposite side.
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
            /// All variants, in order.
            $vis const ALL: [Self; [$(Self::$variant),+].len()] = [$(Self::$variant),+];
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $set:ident { $($(#[$about:meta])* $variant:ident = $name:literal,)+ }) => {
        $crate::closed_set! { $(#[$meta])* $vis enum $set { $($(#[$about])* $variant,)+ } }

        impl $set {
            /// Returns the name that files and command lines use.
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
            $vis const fn $second(self) -> &'static str {
                match self { $(Self::$variant => $more,)+ }
            }
        }
    };
}
