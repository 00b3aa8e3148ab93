//! The words of the network: parts, kinds, landmarks, limbs and how they lie.
//!
//! The order within a list is the order in which the network gives its values. Left and right are
//! sides of the picture, not the wearer's.

use std::fmt;

/// A list of words: an enum whose variants stand in the network's order, with their names.
macro_rules! words {
    ($(#[$about:meta])* $List:ident { $($(#[$each:meta])* $Word:ident = $name:literal,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $List {
            $($(#[$each])* $Word,)+
        }

        impl $List {
            /// All of them, in the network's order.
            pub const ALL: [$List; [$($name),+].len()] = [$($List::$Word),+];

            /// Its name, as in the truth of training: lower case, words joined by `_`.
            pub fn name(self) -> &'static str {
                match self {
                    $($List::$Word => $name,)+
                }
            }
        }

        impl fmt::Display for $List {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

words! {
    /// What a pixel of the photo shows. A pixel shows one part alone.
    Part {
        /// Whatever is neither garment nor hanger.
        Ground = "ground",
        /// The body of a garment: front or back of a top, the seat of trousers, a skirt.
        Body = "body",
        /// The sleeve on the left of the picture.
        SleeveLeft = "sleeve_left",
        /// The sleeve on the right of the picture.
        SleeveRight = "sleeve_right",
        /// The leg on the left of the picture.
        LegLeft = "leg_left",
        /// The leg on the right of the picture.
        LegRight = "leg_right",
        /// The hood.
        Hood = "hood",
        /// The collar.
        Collar = "collar",
        /// The inside of the far layer, seen through an opening such as the neck.
        Inside = "inside",
        /// The waistband.
        Waistband = "waistband",
        /// What the garment hangs on.
        Hanger = "hanger",
    }
}

impl Part {
    /// Whether it belongs to the garment: all but ground and hanger.
    pub fn is_garment(self) -> bool {
        !matches!(self, Part::Ground | Part::Hanger)
    }
}

words! {
    /// What the garment is.
    GarmentKind {
        /// A T-shirt: short sleeves, no collar.
        Tshirt = "tshirt",
        /// A polo shirt: short sleeves, a collar, a placket.
        Polo = "polo",
        /// A top with long sleeves, without buttons.
        Longsleeve = "longsleeve",
        /// A shirt or blouse that is buttoned all the way down.
        Shirt = "shirt",
        /// A top without sleeves.
        Sleeveless = "sleeveless",
        /// A dress.
        Dress = "dress",
        /// A skirt.
        Skirt = "skirt",
        /// Trousers.
        Trousers = "trousers",
        /// Shorts.
        Shorts = "shorts",
        /// A jacket or coat.
        Jacket = "jacket",
        /// A top with a hood.
        Hoodie = "hoodie",
        /// A top and trousers in one.
        Onepiece = "onepiece",
    }
}

words! {
    /// A point of a garment that has a name.
    Landmark {
        /// Where the neckline meets the shoulder, left.
        NeckLeft = "neck_left",
        /// Where the neckline meets the shoulder, right.
        NeckRight = "neck_right",
        /// The lowest point of the neckline at the front.
        NeckFront = "neck_front",
        /// The outer end of the left shoulder.
        ShoulderLeft = "shoulder_left",
        /// The outer end of the right shoulder.
        ShoulderRight = "shoulder_right",
        /// The left armpit.
        ArmpitLeft = "armpit_left",
        /// The right armpit.
        ArmpitRight = "armpit_right",
        /// The outer end of the left sleeve's hem.
        CuffLeftOuter = "cuff_left_outer",
        /// The inner end of the left sleeve's hem, on the armpit's side.
        CuffLeftInner = "cuff_left_inner",
        /// The outer end of the right sleeve's hem.
        CuffRightOuter = "cuff_right_outer",
        /// The inner end of the right sleeve's hem, on the armpit's side.
        CuffRightInner = "cuff_right_inner",
        /// The left end of the waist.
        WaistLeft = "waist_left",
        /// The right end of the waist.
        WaistRight = "waist_right",
        /// Where the legs part.
        Fork = "fork",
        /// The left end of the hem.
        HemLeft = "hem_left",
        /// The right end of the hem.
        HemRight = "hem_right",
        /// The outer end of the left leg's hem.
        LegLeftOuter = "leg_left_outer",
        /// The inner end of the left leg's hem.
        LegLeftInner = "leg_left_inner",
        /// The outer end of the right leg's hem.
        LegRightOuter = "leg_right_outer",
        /// The inner end of the right leg's hem.
        LegRightInner = "leg_right_inner",
    }
}

words! {
    /// What may lie apart from a garment's body, or on it.
    Limb {
        /// The sleeve on the left of the picture.
        SleeveLeft = "sleeve_left",
        /// The sleeve on the right of the picture.
        SleeveRight = "sleeve_right",
        /// The leg on the left of the picture.
        LegLeft = "leg_left",
        /// The leg on the right of the picture.
        LegRight = "leg_right",
    }
}

words! {
    /// How a limb lies.
    Lie {
        /// The garment has no such limb, or the photo does not show it.
        Absent = "absent",
        /// Ground shows between the limb and the rest of the garment.
        Apart = "apart",
        /// The limb touches the rest of the garment and covers none of it.
        Beside = "beside",
        /// The limb covers a part of the rest of the garment.
        Over = "over",
        /// The limb is folded, onto itself or behind.
        Folded = "folded",
    }
}
