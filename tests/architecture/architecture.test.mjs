/**
 * A technique is its folders and one line: nobody else names it. And a room includes only what stands below it, which
 * the linker alone does not say of headers.
 */
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const kTechniques = readdirSync('src/techniques', { withFileTypes: true })
  .filter((entry) => entry.isDirectory())
  .map((entry) => entry.name);

// Rooms of src/ from the ground up; a room includes itself and those before it. The floor of light is one of its own.
const kRooms = [['base'], ['scene', 'graph', 'diffusion'], ['gl', 'truth'], ['views'], ['light'], ['technique'],
  ['techniques'], ['frame'], ['measure'], ['viewer'], ['cli', 'web']];

const sources = (folder) =>
  readdirSync(join('src', folder), { recursive: true })
    .filter((name) => /\.(cpp|h)$/.test(name))
    .map((name) => join(folder, name));

/** Code without its comments. */
const codeOf = (file) =>
  readFileSync(join('src', file), 'utf8').replace(/\/\/[^\n]*/g, '').replace(/\/\*.*?\*\//gs, '');

/** What in a file names a technique: its headers, its namespace, its name as a text. */
function namesIn(code, techniques = kTechniques) {
  const found = [];
  for (const name of techniques)
    for (const pattern of [`"techniques/${name}/[^"]*"`, `\\b${name}::`, `"${name}"`])
      found.push(...(code.match(new RegExp(pattern, 'g')) ?? []));
  return found;
}

test('a file that names a technique is seen', () => {
  assert.deepEqual(namesIn('#include "techniques/relief/Relief.h"', ['relief']), ['"techniques/relief/Relief.h"']);
  assert.deepEqual(namesIn('need(scene, "relief"); relief::Settings s;', ['relief']), ['relief::', '"relief"']);
  assert.deepEqual(namesIn('text("a relief"); reliefPlan();', ['relief']), []);
});

test('no room outside a technique names it', () => {
  const rooms = kRooms.flat().filter((room) => !['techniques', 'truth', 'scene', 'base'].includes(room));
  const naming = rooms.flatMap(sources).filter((file) => namesIn(codeOf(file)).length > 0);
  assert.deepEqual(naming.map((file) => `${file}: ${namesIn(codeOf(file)).join(', ')}`), []);
});

test('techniques do not include each other', () => {
  for (const name of kTechniques) {
    const others = kTechniques.filter((other) => other !== name);
    for (const file of sources(join('techniques', name)))
      assert.doesNotMatch(codeOf(file), new RegExp(`#include "techniques/(${others.join('|')})/`), file);
  }
});

test('rooms include only what stands below them', () => {
  for (const [floor, rooms] of kRooms.entries()) {
    const above = kRooms.slice(floor + 1).flat();
    const beside = rooms.length > 1 && floor !== 1 ? rooms : [];
    for (const room of rooms)
      for (const file of sources(room)) {
        const parts = /^techniques\/[^/]+\/(bench|panel)\//.test(file); // on the floors of measure and viewer
        const forbidden = parts ? ['cli', 'web'] : [...above, ...beside.filter((other) => other !== room)];
        if (forbidden.length === 0) continue;
        assert.doesNotMatch(codeOf(file), new RegExp(`#include "(${forbidden.join('|')})/`), file);
      }
  }
});
