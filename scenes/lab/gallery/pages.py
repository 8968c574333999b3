"""All pages of the gallery, in the order in which they are turned."""

from scenes.lab.gallery import extremes, masks, motions, piles, sweeps

PAGES = (*sweeps.PAGES, *motions.PAGES, *piles.PAGES, *masks.PAGES, *extremes.PAGES)
