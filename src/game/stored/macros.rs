//! The macro that implements [`Stored`](super::Stored) from one list of the fields of a type.

/// Implements [`Stored`], for `struct Name { field, … }` and `enum Name { 0: Variant { field, … }, … }`, and
/// [`StoredPart`], for `part of Name { field, … } level { field, … }`, whose last list names the fields that
/// the level gives.
#[doc(hidden)]
#[macro_export]
macro_rules! stored {
    (struct $name:ident { $($field:ident),* $(,)? }) => {
        impl $crate::game::stored::Stored for $name {
            fn write(&self, out: &mut $crate::game::stored::Writer) {
                let Self { $($field),* } = self;
                $($crate::game::stored::Stored::write($field, out);)*
            }

            fn read(
                input: &mut $crate::game::stored::Reader,
            ) -> Result<Self, $crate::game::Unrestorable> {
                $(let $field = $crate::game::stored::Stored::read(input)?;)*
                Ok(Self { $($field),* })
            }
        }
    };
    (part of $name:ident { $($field:ident),* $(,)? } level { $($given:ident),* $(,)? }) => {
        impl $crate::game::stored::StoredPart for $name {
            fn write(&self, out: &mut $crate::game::stored::Writer) {
                let Self { $($field,)* $($given: _,)* } = self;
                $($crate::game::stored::Stored::write($field, out);)*
            }

            fn read_over(
                &mut self,
                input: &mut $crate::game::stored::Reader,
            ) -> Result<(), $crate::game::Unrestorable> {
                let Self { $($field,)* $($given: _,)* } = self;
                $(*$field = $crate::game::stored::Stored::read(input)?;)*
                Ok(())
            }
        }
    };
    (enum $name:ident { $($tag:literal: $variant:ident $({ $($field:ident),* })? $(( $($item:ident),* ))?),* $(,)? }) => {
        impl $crate::game::stored::Stored for $name {
            fn write(&self, out: &mut $crate::game::stored::Writer) {
                match self {
                    $(Self::$variant $({ $($field),* })? $(( $($item),* ))? => {
                        out.number($tag);
                        $($($crate::game::stored::Stored::write($field, out);)*)?
                        $($($crate::game::stored::Stored::write($item, out);)*)?
                    })*
                }
            }

            fn read(
                input: &mut $crate::game::stored::Reader,
            ) -> Result<Self, $crate::game::Unrestorable> {
                Ok(match input.number()? {
                    $($tag => {
                        $($(let $field = $crate::game::stored::Stored::read(input)?;)*)?
                        $($(let $item = $crate::game::stored::Stored::read(input)?;)*)?
                        Self::$variant $({ $($field),* })? $(( $($item),* ))?
                    })*
                    _ => return Err($crate::game::Unrestorable::Damaged("a kind")),
                })
            }
        }
    };
}
