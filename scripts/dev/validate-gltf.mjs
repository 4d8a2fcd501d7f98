#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Runs the Khronos glTF validator over .gltf and .glb files and prints counts of its messages.
//
//   node scripts/dev/validate-gltf.mjs [--module DIR] FILE...
//   node scripts/dev/validate-gltf.mjs [--module DIR] --baseline IN OUT [--baseline IN OUT]...
//
// DIR is the folder of the npm package gltf-validator; without it, NODE_PATH is searched. With a
// baseline, errors of OUT count, but other messages only if they are new: of a code that IN has fewer
// of, in proportion to its primitives, because levels of detail repeat what is said of them. Images
// that are missing in both count as such messages. Exit status: 0 if there are no errors or (new)
// warnings, 1 if there are, 2 if the validator is not to be found.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import process from "node:process";

const severities = ["error", "warning", "info", "hint"];

function parseArguments(list) {
    const options = { module: null, pairs: [] };
    for (let i = 0; i < list.length; ++i) {
        if (list[i] === "--module") options.module = list[++i];
        else if (list[i] === "--baseline") options.pairs.push({ before: list[++i], after: list[++i] });
        else options.pairs.push({ before: null, after: list[i] });
    }
    if (options.pairs.length === 0 || options.pairs.some((pair) => pair.after === undefined)) {
        console.error("validate-gltf: error: no file given; see the head of the script");
        process.exit(2);
    }
    return options;
}

function loadValidator(folder) {
    try {
        const require = createRequire(import.meta.url);
        return require(folder ? path.resolve(folder) : "gltf-validator");
    } catch (error) {
        console.error(`validate-gltf: error: gltf-validator is not to be found (${error.message}); ` +
            "npm install gltf-validator, then --module DIR");
        process.exit(2);
    }
}

/// Returns { messages, primitives }.
async function reportOn(validator, file) {
    const bytes = new Uint8Array(await readFile(file));
    const report = await validator.validateBytes(bytes, {
        uri: path.basename(file),
        maxIssues: 0,
        externalResourceFunction: async (uri) =>
            new Uint8Array(await readFile(path.join(path.dirname(file), decodeURIComponent(uri)))),
    }).catch((error) => ({ issues: { messages: [{ code: String(error), severity: 0, pointer: "" }] } }));
    return { messages: report.issues.messages, primitives: report.info?.drawCallCount ?? 0 };
}

/// Errors in `after`, except missing files, and other messages whose code stands more often in
/// `after` than in `before`, for each primitive: the surplus, the last ones.
function newMessages(before, after) {
    const copies = Math.max(1, Math.ceil(after.primitives / Math.max(1, before.primitives)));
    const allowed = new Map();
    for (const message of before.messages)
        allowed.set(message.code, (allowed.get(message.code) ?? 0) + copies);
    return after.messages.filter((message) => {
        if (message.severity === 0 && message.code !== "IO_ERROR") return true;
        const left = allowed.get(message.code) ?? 0;
        allowed.set(message.code, left - 1);
        return left <= 0;
    });
}

const options = parseArguments(process.argv.slice(2));
const validator = loadValidator(options.module);
let isClean = true;
for (const { before, after } of options.pairs) {
    const report = await reportOn(validator, after);
    const messages = before ? newMessages(await reportOn(validator, before), report) : report.messages;
    const counts = severities.map((_, severity) =>
        messages.filter((message) => message.severity === severity).length);
    isClean = isClean && counts[0] === 0 && counts[1] === 0;
    const summary = severities.map((name, severity) => `${counts[severity]} ${name}s`).join(", ");
    console.log(`${after}: ${before ? "new: " : ""}${summary}`);
    const shown = new Map();
    for (const { code, severity, pointer, message } of messages) {
        const seen = shown.get(code) ?? 0;
        shown.set(code, seen + 1);
        if (severity <= 1 && seen < 3) console.log(`  ${severities[severity]} ${code} ${pointer} ${message ?? ""}`);
        else if (seen === 0) console.log(`  ${severities[severity]} ${code}`);
    }
}
process.exit(isClean ? 0 : 1);
