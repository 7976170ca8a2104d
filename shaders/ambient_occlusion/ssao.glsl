// Screen-space ambient occlusion over the hemisphere (Mittring 2007; thesis 4.4.3.2): points that
// something near stands before are occluded.
float point_occlusion(float rise, bool blocked) { return blocked ? 1.0 : 0.0; }
