// Drafts a FreeSewing design to measure and writes it as an SVG file that toile reads.
//
//   node draft.mjs DESIGN MEASUREMENTS OUT.svg [--only PART,PART] [--OPTION VALUE ...]
//
// DESIGN        teagan, aaron, penelope, titan, brian, or any other design that is installed
// MEASUREMENTS  a JSON file of lengths in mm and angles in degrees, or a size of FreeSewing's own models such as cisFemaleAdult36
// --only        the parts to draft, for example front,back
// --OPTION      an option of the design, for example --chestEase 0.1
import { readFile, writeFile } from 'node:fs/promises'

const usage = 'usage: node draft.mjs DESIGN MEASUREMENTS OUT.svg [--only PART,PART] [--OPTION VALUE ...]'

function fail(message) {
  console.error(message)
  process.exit(1)
}

async function designOf(name) {
  const design = await import(`@freesewing/${name}`).catch(() =>
    fail(`there is no design "${name}" here: npm install @freesewing/${name}`)
  )
  const key = Object.keys(design).find((k) => k.toLowerCase() === name && typeof design[k] === 'function')
  return key ? design[key] : fail(`@freesewing/${name} is no design`)
}

async function measurementsOf(source) {
  if (source.endsWith('.json')) return JSON.parse(await readFile(source, 'utf8'))
  const models = await import('@freesewing/models')
  return models[source] ?? fail(`there is no model "${source}": cisFemaleAdult28 to 46, cisMaleAdult32 to 50`)
}

function settingsOf(design, rest) {
  const settings = { options: {} }
  for (let i = 0; i < rest.length; i += 2) {
    const [key, value] = [rest[i].replace(/^--/, ''), rest[i + 1]]
    if (value === undefined) fail(usage)
    if (key === 'only') settings.only = value.split(',').map((part) => (part.includes('.') ? part : `${design}.${part}`))
    else settings.options[key] = isNaN(value) ? (value === 'true' ? true : value === 'false' ? false : value) : Number(value)
  }
  return settings
}

const [name, source, out, ...rest] = process.argv.slice(2)
if (!out) fail(usage)
const Design = await designOf(name)
const measurements = await measurementsOf(source)
// The title with the number of copies is part of the complete draft; seam allowance is not sewn along, so none is drawn.
const pattern = new Design({ measurements, complete: true, paperless: false, sa: 0, ...settingsOf(name, rest) }).draft()
const errors = pattern.setStores.flatMap((store) => store.logs?.error ?? [])
if (errors.length > 0) fail(errors.map((e) => (Array.isArray(e) ? e.join(' ') : String(e))).join('\n'))
const svg = pattern.render()
await writeFile(out, svg)
console.log(`${out}: ${(svg.match(/id="fs-stack-[^"]*-part-/g) ?? []).length} parts`)
