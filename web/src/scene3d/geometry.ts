// Geometry of three.js from a mesh.
import { BufferAttribute, BufferGeometry } from 'three';
import type { MeshData } from './mesh';

/** Positions, normals and colours of a mesh. */
export function geometryOf(data: MeshData): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(data.positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(data.normals, 3));
  geometry.setAttribute('color', new BufferAttribute(data.colours, 3));
  return geometry;
}
