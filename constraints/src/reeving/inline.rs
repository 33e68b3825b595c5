//! Small arrays written out: a closure may stay a function of its own, which doesn't see the registers behind the door of
//! [`ropewalk_core::run`].

/// Two values, by their number.
macro_rules! two {
    (|$k:ident| $of:expr) => {
        [
            {
                let $k = 0;
                $of
            },
            {
                let $k = 1;
                $of
            },
        ]
    };
}

/// Three values, by their number.
macro_rules! three {
    (|$i:ident| $of:expr) => {
        [
            {
                let $i = 0;
                $of
            },
            {
                let $i = 1;
                $of
            },
            {
                let $i = 2;
                $of
            },
        ]
    };
}

/// What becomes of three components.
macro_rules! each {
    ($v:expr, |$x:ident| $of:expr) => {{
        let [x, y, z] = $v;
        [
            {
                let $x = x;
                $of
            },
            {
                let $x = y;
                $of
            },
            {
                let $x = z;
                $of
            },
        ]
    }};
}

pub(super) use {each, three, two};
