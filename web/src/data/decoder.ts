// SPDX-License-Identifier: Apache-2.0
// Questions to the decoding worker, and where blobs come from: the page itself or the server it came from.
import DecodeWorker from './worker?worker&inline';
import { ReportError, type BlobInfo, type Packed } from './format';
import type { Answer, Part, Question, Reply, Source } from './worker';

export class Decoder {
  private worker = new DecodeWorker();
  private waiting = new Map<number, { done: (answer: Answer) => void; failed: (error: Error) => void }>();
  private next = 0;

  constructor(private blobs: BlobInfo[]) {
    this.worker.onmessage = (message: MessageEvent<Reply>) => {
      const reply = message.data;
      const promise = this.waiting.get(reply.id);
      this.waiting.delete(reply.id);
      if ('error' in reply) promise?.failed(new ReportError(reply.error));
      else promise?.done(reply.answer);
    };
    this.worker.onerror = (event) => {
      for (const promise of this.waiting.values()) promise.failed(new ReportError(`The decoder stopped: ${event.message}`));
      this.waiting.clear();
    };
  }

  ask<T extends Answer>(question: Question): Promise<T> {
    const id = this.next++;
    return new Promise<T>((done, failed) => {
      this.waiting.set(id, { done: done as (answer: Answer) => void, failed });
      this.worker.postMessage({ id, question });
    });
  }

  async part(packed: Packed): Promise<Part> {
    return { source: await this.source(packed.blob), planes: packed.planes };
  }

  async source(index: number): Promise<Source> {
    const info = this.blobs[index];
    if (!info) throw new ReportError(`The page names a piece of data (${index}) that it does not hold.`);
    if (info.src !== undefined) {
      const response = await fetch(info.src);
      if (!response.ok) throw new ReportError(`${info.src}: the server answers ${response.status}.`);
      return response.arrayBuffer();
    }
    const text = document.getElementById(`carus-blob-${index}`)?.textContent;
    if (!text) throw new ReportError(`The page is cut short: piece ${index} of its data is missing.`);
    return text;
  }

  close(): void {
    this.worker.terminate();
    this.waiting.clear();
  }
}
