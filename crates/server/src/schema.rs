//! The types of text in the API's description. A client that follows the patterns sends only names that are accepted.
//! The code that uses a value checks it again, and explains errors.
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
    /// A short name that is used in URLs.
    Slug, r"^[a-z0-9][a-z0-9._-]*$", 60, "physics";
    /// A name that people see, without invisible characters and without spaces at its ends.
    Title, "^[^\\s\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0]\
    ([^\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0]*\
    [^\\s\\x00-\\x1f\\x7f-\\x9f\\xad\\u115f\\u1160\\u180e\
    \\u200b-\\u200f\\u202a-\\u202e\\u2060-\\u206f\\u3164\\ufeff\\uffa0])?$", 200, "Milestone one";
    /// A SHA-256 digest in lower-case hexadecimal.
    Digest, r"^[0-9a-f]{64}$", 64, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
    /// The name of a file, without a path.
    FileName, r"^[A-Za-z0-9_][A-Za-z0-9._-]*$", 100, "FOSSSim";
    /// An identifier from another system, without control characters.
    Word, r"^[^\x00-\x1f\x7f-\x9f]+$", 255, "10000000000001";
    /// An HTTPS URL to which the service sends requests.
    HttpsUrl, "^https://[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?\
    (\\.[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?){0,5}\
    (:([1-9][0-9]{3}|[1-5][0-9]{4}))?(/[A-Za-z0-9._~/-]*)?$", 2000, "https://lms.example.org/mod/lti/auth.php";
    /// A host name, with the port if it is not 443.
    Host, "^[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?\
    (\\.[a-z][a-z0-9]{0,30}(-[a-z0-9]{1,20})?){0,5}(:([1-9][0-9]{3}|[1-5][0-9]{4}))?$", 255, "lms.example.org";
    /// A nonnegative number with exactly the digits that the grader wrote.
    Decimal, r"^[0-9]{1,9}(\.[0-9]{1,20})?$", 30, "97.5";
    /// The file name of a report.
    ReportName, r"^(grade\.json|report\.(txt|html)|(staff|published)\.html)$", 20, "grade.json";
    /// The code of a verdict, such as `AC`.
    Code, r"^[A-Z]{1,4}$", 4, "WA";
}

impl PartialSchema for crate::store::Digest {
    fn schema() -> RefOr<Schema> {
        Digest::schema()
    }
}

impl ToSchema for crate::store::Digest {}
