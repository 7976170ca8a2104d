// A variation of Alchemy ambient obscurance (McGuire et al. 2011; thesis 4.4.3.1): what is recorded
// occludes by the sine of its elevation, wherever the point that led there lies.
float point_occlusion(float rise, bool blocked) { return rise; }
