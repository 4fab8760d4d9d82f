//! Text types of the API's description. A client that follows the patterns sends only accepted names. The checks with
//! readable messages are where the values are used.
use utoipa::{
    PartialSchema, ToSchema,
    openapi::{
        RefOr, Schema,
        schema::{ObjectBuilder, Type},
    },
};

macro_rules! texts {
    ($($(#[doc = $doc:literal])* $name:ident, $pattern:literal, $most:literal, $example:literal;)*) => {
        $($(#[doc = $doc])*
        pub enum $name {}

        impl PartialSchema for $name {
            fn schema() -> RefOr<Schema> {
                ObjectBuilder::new()
                    .schema_type(Type::String)
                    .description(Some(concat!($($doc),*).trim()))
                    .pattern(Some($pattern))
                    .min_length(Some(1))
                    .max_length(Some($most))
                    .examples([$example])
                    .into()
            }
        }

        impl ToSchema for $name {})*
    };
}

texts! {
    /// A name that is used in addresses.
    Slug, r"^[a-z0-9][a-z0-9._-]*$", 60, "physics";
    /// A name that people gave to something, without invisible characters or spaces at its ends.
    Title, "^[^\\s\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0]\
    ([^\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0]*\
    [^\\s\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0])?$", 200, "Milestone one";
    /// A SHA-256 digest.
    Digest, r"^[0-9a-f]{64}$", 64, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
    /// The name of a file, without a path.
    FileName, r"^[A-Za-z0-9_][A-Za-z0-9._-]*$", 100, "FOSSSim";
    /// A name from another system, without control characters.
    Word, r"^[^\x00-\x1f\x7f-\x9f]+$", 255, "10000000000001";
    /// An HTTPS address that the service calls.
    HttpsUrl, r"^https://[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?(\.[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?){0,5}(:([1-9][0-9]{3}|[1-5][0-9]{4}))?(/[A-Za-z0-9._~/-]*)?$",
        2000, "https://lms.example.org/mod/lti/auth.php";
    /// A host, with a port if it is not 443.
    Host, r"^[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?(\.[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?){0,5}(:([1-9][0-9]{3}|[1-5][0-9]{4}))?$",
        255, "lms.example.org";
    /// A nonnegative number, with exactly the grader's digits.
    Decimal, r"^[0-9]{1,9}(\.[0-9]{1,20})?$", 30, "97.5";
    /// The name of a report.
    ReportName, r"^(grade\.json|report\.(txt|html)|(staff|published)\.html)$", 20, "grade.json";
    /// The code of a verdict.
    Code, r"^[A-Z]{1,4}$", 4, "WA";
}

impl PartialSchema for crate::store::Digest {
    fn schema() -> RefOr<Schema> {
        Digest::schema()
    }
}

impl ToSchema for crate::store::Digest {}
