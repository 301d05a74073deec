//! Faults of the data: nothing is wrong with the model.

use lacuna::prelude::*;

/// Declares a fault of the data: no w, only rows of the column named by `into`.
macro_rules! fault {
    ($name:ident, $key:literal, $summary:literal, $title:literal, $value:literal) => {
        #[doc = concat!("Data fault: ", $summary, ".")]
        #[derive(Debug, Clone, Default, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            #[doc = $value]
            #[serde(default)]
            pub value: f64,
            /// Rows concerned, 1 being the first sample.
            #[serde(default)]
            pub rows: Vec<usize>,
        }

        impl Effect for $name {
            fn card(&self) -> EffectCard {
                EffectCard::law(vec![EffectParameter::coefficient("value", self.value, UnitRule::None)])
                    .by(Mechanism::Data)
                    .needs(Needs::Nothing)
                    .places(Places::default())
                    .rank(0)
            }

            fn title(&self, _: &Named) -> String {
                $title.into()
            }

            /// The data are at fault, not the model.
            #[inline(always)]
            fn law<R: Real>(&self, _: &Arguments<R>, _: &mut [R]) -> R {
                R::constant(0.0)
            }
        }

        lacuna::register!(CandidateEffect for $name, $key, $summary);
    };
}

fault!(Outliers, "outliers", "single samples far off", "Outliers", "Share of all samples.");
fault!(
    Dropout,
    "dropout",
    "samples that fell to a fixed value",
    "A dropout",
    "The value they fell to."
);
fault!(
    Clipping,
    "clipping",
    "values cut off at a limit of the instrument",
    "Clipped values",
    "The limit."
);
fault!(Stuck, "stuck", "a reading that stands still", "A stuck reading", "The value it stands at.");
fault!(
    Unrelated,
    "unrelated",
    "a column that has nothing to do with the others",
    "A column without relation",
    "Mean of its readings."
);
fault!(
    Quantisation,
    "quantisation",
    "coarse steps of the converter",
    "Coarse quantisation",
    "Step of the converter."
);
fault!(
    TimeShift,
    "time_shift",
    "one column recorded early or late",
    "A shifted column",
    "Shift in s, positive where the column is late."
);
fault!(SwappedSign, "swapped_sign", "a column of the wrong sign", "A swapped sign", "Not used.");
fault!(
    WrongSamplingTime,
    "sampling_time",
    "another sampling time than stated",
    "A wrong sampling time",
    "The sampling time that fits, in s."
);
