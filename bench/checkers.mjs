#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// What the Khronos validator and glTF-Transform say of models, for bench/checkers:
//
//   node bench/checkers.mjs FOLDER_OF_NODE_MODULES FILE...
//
// Prints JSON: the versions of the packages, null for those that are not installed, and for each file the codes of the
// validator's errors and warnings, and whether glTF-Transform can inspect it.
import { readFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import process from "node:process";
import { pathToFileURL } from "node:url";

const [folder, ...files] = process.argv.slice(2);
const require = createRequire(path.resolve(folder, "node_modules", "none.js"));

function versionOf(name) {
    try {
        const file = path.resolve(folder, "node_modules", name, "package.json");
        return JSON.parse(readFileSync(file)).version;
    } catch {
        return null;
    }
}

async function transform() {
    const load = (name) => import(pathToFileURL(require.resolve(name)));
    const [core, functions, extensions] = await Promise.all(
        ["@gltf-transform/core", "@gltf-transform/functions", "@gltf-transform/extensions"].map(load));
    const io = new core.NodeIO().registerExtensions(extensions.ALL_EXTENSIONS).setLogger(new core.Logger(core.Verbosity.SILENT));
    return async (file) => {
        try {
            functions.inspect(await io.read(file));
            return true;
        } catch {
            return false;
        }
    };
}

function validate(validator) {
    return async (file) => {
        const read = async (name) => new Uint8Array(await readFile(name));
        const report = await validator.validateBytes(await read(file), {
            uri: path.basename(file),
            maxIssues: 0,
            externalResourceFunction: (uri) => read(path.join(path.dirname(file), decodeURIComponent(uri))),
        }).catch((error) => ({ issues: { messages: [{ code: String(error), severity: 0 }] } }));
        return report.issues.messages.filter((message) => message.severity < 2).map((message) => message.code);
    };
}

const versions = { validator: versionOf("gltf-validator"), transform: versionOf("@gltf-transform/core") };
const codesOf = versions.validator ? validate(require("gltf-validator")) : null;
const inspects = versions.transform ? await transform() : null;
const results = {};
for (const file of files)
    results[file] = { codes: codesOf && await codesOf(file), inspects: inspects && await inspects(file) };
console.log(JSON.stringify({ versions, results }));
