# An image that grades programs:
#   docker build -t fosssim-oracle .
#   docker run --rm -v "$PWD/submissions:/submissions:ro" -v "$PWD/grades:/grades" \
#       fosssim-oracle grade /submissions --output /grades
# Docker's default seccomp profile is enough; no privileges are needed. Without a registry, name other bases that hold what
# is installed here (scripts/container-test does): --build-arg BUILD_BASE=... --build-arg BASE=...
ARG BUILD_BASE=rust:1-slim-bookworm
ARG BASE=debian:bookworm-slim

FROM ${BUILD_BASE} AS build
RUN command -v c++ >/dev/null || \
    { apt-get update && apt-get install -y --no-install-recommends build-essential && rm -rf /var/lib/apt/lists/*; }
WORKDIR /source
COPY . .
RUN cargo build --release --locked

FROM ${BASE}
RUN { command -v c++ >/dev/null && [ -e /usr/include/GL/freeglut.h ] && [ -e /usr/include/png.h ]; } || \
    { apt-get update \
    && apt-get install -y --no-install-recommends build-essential freeglut3-dev libpng-dev \
    && rm -rf /var/lib/apt/lists/*; }
# Outside of /usr, which build steps may read.
COPY --from=build /source/target/release/fosssim-oracle /opt/fosssim/fosssim-oracle
RUN ln -s /opt/fosssim/fosssim-oracle /usr/local/bin/fosssim-oracle
ENTRYPOINT ["fosssim-oracle"]
CMD ["--help"]
