# The tools of relief on Debian 12, for pipelines:
#
#   docker build -t relief .
#   docker run --rm -v "$PWD:/work" relief relief-mesh check model.glb
FROM debian:12 AS build
RUN apt-get -q update && apt-get -q -y --no-install-recommends install ca-certificates
COPY . /src
RUN /src/scripts/install /usr/local

FROM debian:12
COPY --from=build /src/scripts/dev/install-dependencies /tmp/install-dependencies
RUN /tmp/install-dependencies --run && rm -rf /var/lib/apt/lists/* /tmp/install-dependencies
COPY --from=build /usr/local /usr/local
COPY scripts/dev/check-assets /usr/local/bin/
WORKDIR /work
