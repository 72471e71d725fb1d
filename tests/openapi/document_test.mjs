// The document itself against the schema of OpenAPI 3.1. VALIDATOR names the validator's module, DOCUMENT the file.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import test from 'node:test';

const { Validator } = await import(process.env.VALIDATOR);
const text = await readFile(process.env.DOCUMENT, 'utf8');

test('the document is OpenAPI 3.1', async () => {
  const validator = new Validator();
  const result = await validator.validate(JSON.parse(text));
  assert.deepEqual(result.errors ?? [], []);
  assert.equal(result.valid, true);
  assert.equal(validator.version, '3.1');
});

test('a document that is not one is refused', async () => {
  const bad = JSON.parse(text);
  delete bad.paths['/healthz'].get.responses['200'].description;
  assert.equal((await new Validator().validate(bad)).valid, false);
});

test('every reference leads somewhere', () => {
  const document = JSON.parse(text);
  const visit = (value) => {
    if (value === null || typeof value !== 'object') return;
    if (typeof value.$ref === 'string') {
      const found = value.$ref.slice(2).split('/').reduce((at, key) => at?.[key], document);
      assert.notEqual(found, undefined, value.$ref);
    }
    Object.values(value).forEach(visit);
  };
  visit(document);
});

test('operations have names of their own and declare what their path holds', () => {
  const { paths } = JSON.parse(text);
  const names = new Set();
  for (const [path, item] of Object.entries(paths)) {
    const declared = (item.parameters ?? []).map((p) => (p.$ref ? 'id' : p.name));
    assert.deepEqual(declared, [...path.matchAll(/{([^}]*)}/g)].map((m) => m[1]), path);
    for (const method of ['get', 'put', 'post', 'delete', 'patch']) {
      if (!item[method]) continue;
      const name = item[method].operationId;
      assert.ok(name && !names.has(name), `${method} ${path}`);
      names.add(name);
    }
  }
});
