//! The description of the API (OpenAPI 3.1). It combines the handlers' own descriptions with everything that they have
//! in common.
use super::identification::cookie_name;
use crate::{
    problem::Problem,
    schema::{Digest, FileName, Slug},
    task::OutputFile,
};
use axum::http::StatusCode;
use std::collections::BTreeMap;
use utoipa::{
    OpenApi as _,
    openapi::{
        ContentBuilder, OpenApi, RefOr, Required, ResponseBuilder,
        path::{Operation, Parameter, ParameterBuilder, ParameterIn, PathItem},
        schema::{KnownFormat, Object, ObjectBuilder, Ref, Schema, SchemaFormat, Type},
        security::{ApiKey, ApiKeyValue, HttpAuthScheme, HttpBuilder, SecurityRequirement, SecurityScheme},
    },
};

/// The media type of an upload's body.
const UPLOAD_TYPE: &str = "application/octet-stream";

/// The largest integer that every language can read from JSON without rounding.
const MAX_INTEGER: i64 = (1 << 53) - 1;

#[derive(utoipa::OpenApi)]
#[openapi(
    info(
        title = "fosssim-server",
        description = "A course's grading server. Send a token: `Authorization: Bearer fso_...`. Errors are \
                       `application/problem+json`, and say how to fix them. Times are milliseconds since 1970.",
        license(name = "MIT OR Apache-2.0", identifier = "MIT OR Apache-2.0")
    ),
    servers((url = "/", description = "This server")),
    components(schemas(Problem, OutputFile, Slug, FileName, Digest)),
    tags(
        (name = "accounts", description = "Account and tokens of the signed-in person"),
        (name = "courses", description = "Courses and their members"),
        (name = "assignments", description = "Assignments, and a class's results"),
        (name = "submissions", description = "Submissions and their grades"),
        (name = "regrades", description = "Grading all submissions again"),
        (name = "administration", description = "Actions of administrators"),
        (name = "workers", description = "The API for workers on other machines, with a worker's token"),
        (name = "operations", description = "For monitors of the server; without a sign-in")
    )
)]
struct Base;

/// Returns a description that contains only the answers that are sent before a handler runs.
pub(super) fn base_description() -> OpenApi {
    Base::openapi()
}

/// Adds everything that applies to all operations: the ways to sign in, the form of names in URLs, and common
/// answers.
pub(super) fn complete(api: &mut OpenApi) {
    let components = api.components.get_or_insert_default();
    for (name, scheme) in schemes() {
        components.security_schemes.insert(name.to_owned(), scheme.into());
    }
    allow_extension(&mut components.schemas);
    for (path, item) in &mut api.paths.paths {
        for operation in operations(item) {
            name_parts(path, operation);
            complete_operation(operation);
        }
    }
}

/// Allows additional fields in schemas that other schemas include. Otherwise the fields of the including schema would
/// be invalid.
fn allow_extension(schemas: &mut BTreeMap<String, RefOr<Schema>>) {
    let closed: BTreeMap<String, Object> = schemas
        .iter()
        .filter_map(|(name, schema)| match schema {
            RefOr::T(Schema::Object(object)) if object.additional_properties.is_some() => {
                Some((format!("#/components/schemas/{name}"), object.clone()))
            }
            _ => None,
        })
        .collect();
    for schema in schemas.values_mut() {
        let RefOr::T(Schema::AllOf(parts)) = schema else { continue };
        for part in &mut parts.items {
            if let RefOr::Ref(of) = part
                && let Some(object) = closed.get(&of.ref_location)
            {
                let mut open = object.clone();
                open.additional_properties = None;
                *part = Schema::Object(open).into();
            }
        }
    }
}

fn schemes() -> [(&'static str, SecurityScheme); 3] {
    let bearer = |text: &str| {
        SecurityScheme::Http(HttpBuilder::new().scheme(HttpAuthScheme::Bearer).description(Some(text)).build())
    };
    let text = "A browser's session, from signing in; behind HTTPS the cookie is called `__Host-fosssim`. Then a \
        request that changes something needs `Sec-Fetch-Site: same-origin` or this server's `Origin`.";
    let cookie = ApiKeyValue::with_description(cookie_name(false), text);
    [
        ("token", bearer("A person's token (`fso_...`), made on the page \"Account\".")),
        ("session", SecurityScheme::ApiKey(ApiKey::Cookie(cookie))),
        ("worker", bearer("A worker's token (`fsw_...`), made by an administrator.")),
    ]
}

fn operations(item: &mut PathItem) -> impl Iterator<Item = &mut Operation> {
    [&mut item.get, &mut item.put, &mut item.post, &mut item.delete, &mut item.patch].into_iter().flatten()
}

/// Describes the parts of a URL as parameters, and adds the answer for rejected requests.
fn name_parts(path: &str, operation: &mut Operation) {
    let names = path.split('{').skip(1).filter_map(|part| part.split('}').next());
    let parts = names.map(|name| {
        ParameterBuilder::new().name(name).parameter_in(ParameterIn::Path).required(Required::True).build().into()
    });
    let declared = operation.parameters.take().unwrap_or_default();
    let all: Vec<RefOr<Parameter>> = parts.chain(declared).collect();
    operation.parameters = Some(all).filter(|all| !all.is_empty());
    let problem = ContentBuilder::new().schema(Some(Ref::from_schema_name("Problem"))).build();
    let refused = ResponseBuilder::new().content("application/problem+json", problem);
    operation.responses.responses.entry("default".to_owned()).or_insert(refused.build().into());
}

fn complete_operation(operation: &mut Operation) {
    let is_of = |tag: &str| operation.tags.iter().flatten().any(|of| of == tag);
    let required = |name: &str| SecurityRequirement::new(name, Vec::<String>::new());
    // A handler that accepts only some ways to sign in describes them itself.
    let security = match () {
        () if is_of("operations") => Vec::new(),
        () if is_of("workers") => vec![required("worker")],
        () => vec![required("token"), required("session")],
    };
    operation.security.get_or_insert(security);
    for parameter in operation.parameters.iter_mut().flatten() {
        if let RefOr::T(parameter) = parameter {
            complete_parameter(parameter);
        }
    }
    if let Some(RefOr::T(body)) = &mut operation.request_body {
        body.required = Some(Required::True);
        for (kind, content) in &mut body.content {
            if let (RefOr::T(content), UPLOAD_TYPE) = (content, kind.as_str()) {
                content.schema = Some(bytes_schema());
            }
        }
    }
    let responses = &mut operation.responses.responses;
    let takes_file = operation.request_body.as_ref().is_some_and(|body| match body {
        RefOr::T(body) => body.content.contains_key(UPLOAD_TYPE),
        RefOr::Ref(_) => false,
    });
    if let (true, Some(RefOr::T(mut refused))) = (takes_file, responses.get("default").cloned()) {
        refused.description = "The file is rejected and not stored; the body says why".to_owned();
        responses.entry("422".to_owned()).or_insert(RefOr::T(refused));
    }
    for (status, response) in responses {
        if let RefOr::T(response) = response
            && response.description.is_empty()
        {
            response.description = describe_answer(status);
        }
    }
}

/// Completes the schema of a part of a URL or a header, according to its name.
fn complete_parameter(parameter: &mut Parameter) {
    let named = |name: &str| -> RefOr<Schema> { Ref::from_schema_name(name).into() };
    let text = |pattern: &str| -> RefOr<Schema> {
        ObjectBuilder::new().schema_type(Type::String).pattern(Some(pattern)).into()
    };
    let (schema, text) = match (&parameter.parameter_in, parameter.name.as_str()) {
        (ParameterIn::Path, "course") => (named("Slug"), "The course's name in URLs"),
        (ParameterIn::Path, "assignment") => (named("Slug"), "The assignment's name in URLs"),
        (ParameterIn::Path, "login") => (named("Slug"), "The account's login"),
        (ParameterIn::Path, "digest") => (named("Digest"), "The SHA-256 of the file's bytes"),
        (ParameterIn::Path, "name") => (named("Slug"), "The object's name"),
        (ParameterIn::Path, "id") => (number_schema(1), "The number"),
        (ParameterIn::Query, "before") => (number_schema(0), "Only entries before this one"),
        (ParameterIn::Query, "format") => (text("^(csv|jsonl)$"), "`csv` or `jsonl`"),
        (ParameterIn::Query, "form") => (text("^(program|sources|traces)$"), "The kind of the object"),
        (ParameterIn::Header, "Idempotency-Key") => (text("^[!-~]{1,200}$"), "A name that the sender chooses"),
        (ParameterIn::Header, "Fosssim-Lease") => {
            (text("^[0-9]{1,15}:[0-9]{1,15}:[0-9a-f]+$"), "The lease of the job, as JOB:ATTEMPT:KEY")
        }
        _ => return,
    };
    parameter.schema = Some(schema);
    parameter.description.get_or_insert(text.to_owned());
}

/// Returns the schema of an integer that every language can read from JSON without rounding.
fn number_schema(minimum: i64) -> RefOr<Schema> {
    let format = SchemaFormat::KnownFormat(KnownFormat::Int64);
    let number = ObjectBuilder::new().schema_type(Type::Integer).format(Some(format));
    number.minimum(Some(minimum)).maximum(Some(MAX_INTEGER)).into()
}

/// Returns the schema of a file's bytes.
fn bytes_schema() -> RefOr<Schema> {
    let format = SchemaFormat::KnownFormat(KnownFormat::Binary);
    ObjectBuilder::new().schema_type(Type::String).format(Some(format)).min_length(Some(1)).into()
}

/// Returns the description of an answer whose handler does not describe it.
fn describe_answer(status: &str) -> String {
    if status == "default" {
        return "The request was rejected or failed; the body has the reason and the remedy".to_owned();
    }
    let reason = status.parse().ok().and_then(|status| StatusCode::from_u16(status).ok()?.canonical_reason());
    match reason {
        Some("OK") => "The requested data".to_owned(),
        Some("Created") => "The created object".to_owned(),
        reason => reason.unwrap_or("An answer").to_owned(),
    }
}
