// Reads sentences with gps, nmea-simple and @signalk/nmea0183-signalk: read.cjs FILE, a JSON text a line: [tag, line].
// Prints what each made of each, as {"tag", "line", "reader", "outcome"}: an error's text, "unknown" where the library
// has no parser for such a sentence, or the values that the test looks at. Equal outcomes of a reader are told once.
const fs = require('fs')
const path = require('path')

const folder = process.env.SKYLOOP_NODE_FOLDER
const load = (name) => require(require.resolve(name, { paths: [path.resolve(folder)] }))
const GPS = (() => { const module = load('gps'); return module.GPS || module.default || module })()
const { parseNmeaSentence } = load('nmea-simple')
const SignalK = (() => { const module = load('@signalk/nmea0183-signalk'); return module.Parser || module })()

const readers = {
  gps (line) {
    const read = GPS.Parse(line)
    if (read === false && !(line.slice(3).split(',')[0] in GPS.parsers)) return 'unknown'
    if (read === false) throw new Error('no sentence')
    if (read.valid === false) throw new Error('invalid checksum')
    return { type: read.type, lat: read.lat, lon: read.lon, quality: read.quality, heading: read.heading }
  },
  'nmea-simple' (line) {
    try {
      const read = parseNmeaSentence(line)
      return { type: read.sentenceId, lat: read.latitude, lon: read.longitude, quality: read.fixType, heading: read.heading }
    } catch (error) {
      if (error.message.startsWith('No known parser')) return 'unknown'
      throw error
    }
  },
  signalk: (() => {
    const parser = new SignalK()
    return (line) => {
      const known = parser.hooks[line.slice(3, 6)] !== undefined
      const delta = parser.parse(line)
      if (delta === null) return known ? { type: line.slice(3, 6) } : 'unknown'
      const values = Object.fromEntries(delta.updates[0].values.map(({ path, value }) => [path, value]))
      const place = values['navigation.position'] || {}
      return { type: line.slice(3, 6), lat: place.latitude, lon: place.longitude, quality: values['navigation.gnss.methodQuality'],
               heading: values['navigation.headingTrue'], turn: values['navigation.rateOfTurn'] }
    }
  })()
}

const told = new Set()
for (const text of fs.readFileSync(process.argv[2], 'utf8').split('\n').filter(Boolean)) {
  const [tag, line] = JSON.parse(text)
  for (const [reader, read] of Object.entries(readers)) {
    let outcome
    try {
      outcome = { read: read(line) }
    } catch (error) {
      outcome = { error: String(error.message).slice(0, 200) }
    }
    const key = `${tag} ${reader} ${line.slice(3, 6)} ${JSON.stringify(outcome)}`
    if (told.has(key)) continue
    told.add(key)
    console.log(JSON.stringify({ tag, line, reader, ...outcome }))
  }
}
