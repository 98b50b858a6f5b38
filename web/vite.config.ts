// SPDX-License-Identifier: Apache-2.0
// Builds dist/viewer.html: the page with all of its scripts, styles and the worker inside, so that it opens from disk.
import { readFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';

/** What is built in, and whose licence asks for its notice in every copy. */
const BUILT_IN = ['three', 'uplot'];

function notices(): string {
  const texts = BUILT_IN.map((name) => {
    const { version, license } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, 'utf8')) as {
      version: string;
      license: string;
    };
    return `${name} ${version} (${license})\n\n${readFileSync(`node_modules/${name}/LICENSE`, 'utf8').trim()}`;
  });
  const text = texts.join('\n\n');
  if (text.includes('--')) throw new Error('a licence text would end the comment that it stands in');
  return `<!--\nCarus viewer: Apache-2.0. It contains:\n\n${text}\n-->`;
}

/** Moves every emitted script and style sheet into the page and drops the files. */
function onePage(): Plugin {
  return {
    name: 'one-page',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['index.html'];
      if (page?.type !== 'asset') throw new Error('no index.html in the bundle');
      let html = String(page.source);
      for (const [name, item] of Object.entries(bundle)) {
        if (item === page) continue;
        if (item.type === 'chunk') {
          const tag = new RegExp(`<script[^>]*src="[^"]*${name}"[^>]*></script>`);
          if (!tag.test(html)) throw new Error(`${name} is not referred to by the page: it would be lost`);
          html = html.replace(tag, '');
          // In a script element, "</script" ends it and "<!--" changes how it is parsed.
          const code = item.code.replace(/<\/script/g, '<\\/script').replace(/<!--/g, '<\\!--');
          html = html.replace('</body>', () => `<script type="module">${code}</script>\n</body>`);
        } else {
          const tag = new RegExp(`<link[^>]*href="[^"]*${name}"[^>]*>`);
          if (!tag.test(html)) throw new Error(`${name} is not referred to by the page: it would be lost`);
          html = html.replace(tag, () => `<style>${String(item.source)}</style>`);
        }
        delete bundle[name];
      }
      html = html.replace('</html>', () => `${notices()}\n</html>`);
      if (html.split('<!--CARUS-DATA-->').length !== 2) throw new Error('the page must hold the place of the data exactly once');
      page.fileName = 'viewer.html';
      page.source = html;
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [onePage()],
  build: { target: 'es2022', cssCodeSplit: false, assetsInlineLimit: 1e8, modulePreload: false, chunkSizeWarningLimit: 2000 },
  worker: { format: 'iife' },
});
